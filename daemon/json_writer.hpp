// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lilo {

/// Writes one JSON object into a buffer of its own: no allocation, and by construction nothing that
/// is no JSON. Numbers that are not finite are left out with their name; what does not fit makes
/// the whole object invalid instead of cutting it.
class JsonWriter {
 public:
  static constexpr std::size_t kCapacity = 1200;  ///< a datagram that no Ethernet link fragments

  JsonWriter() { put('{'); }

  /// Items of an array have an empty name.
  void begin_object(std::string_view name);
  void end_object();
  void begin_array(std::string_view name);
  void end_array();

  /// `decimals` after the point, trailing zeros left out.
  void number(std::string_view name, double value, int decimals);
  /// Four significant digits: for variances, whose size nobody knows beforehand.
  void scientific(double value);
  void integer(std::string_view name, std::int64_t value);
  void unsigned_integer(std::string_view name, std::uint64_t value);
  void boolean(std::string_view name, bool value);
  /// Quotes, backslashes and control characters are escaped; bytes that are no ASCII become '?'.
  void text(std::string_view name, std::string_view value);
  void item(std::string_view value);
  /// Seconds as an exact decimal of nanoseconds; a double could not hold them.
  void seconds(std::string_view name, std::int64_t ns);

  /// Ends the object and returns it; empty when it did not fit.
  [[nodiscard]] std::string_view finish();

 private:
  void put(char c);
  void put(std::string_view text);
  void key(std::string_view name);
  void quoted(std::string_view text);

  std::array<char, kCapacity> buffer_;
  std::size_t size_ = 0;
  bool fits_ = true;
  bool first_ = true;  // no comma before the next key
};

}  // namespace lilo
