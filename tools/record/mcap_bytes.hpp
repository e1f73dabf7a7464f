// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace lilo::mcap {

/// Values as MCAP has them (mcap.dev/spec, "Serialization"): little-endian, strings and maps behind
/// their length in bytes.
class Bytes {
 public:
  void u8(std::uint8_t value) { text_ += static_cast<char>(value); }
  void u16(std::uint16_t value) { integer(value, 2); }
  void u32(std::uint32_t value) { integer(value, 4); }
  void u64(std::uint64_t value) { integer(value, 8); }
  void raw(std::string_view bytes) { text_ += bytes; }
  void string(std::string_view text) {
    u32(static_cast<std::uint32_t>(text.size()));
    raw(text);
  }
  void strings(const std::map<std::string, std::string>& map) {
    Bytes inner;
    for (const auto& [key, value] : map) {
      inner.string(key);
      inner.string(value);
    }
    string(inner.text());
  }
  /// A record: what it is, its length, its content.
  void record(std::uint8_t opcode, const Bytes& content) {
    u8(opcode);
    u64(content.size());
    raw(content.text());
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  void clear() { text_.clear(); }

 private:
  void integer(std::uint64_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) u8(static_cast<std::uint8_t>(value >> (8 * k)));
  }

  std::string text_;
};

}  // namespace lilo::mcap
