// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lilo {

enum class Colour : std::uint8_t { none, good, warning, bad, faint, bold };

/// Colours for people: on a terminal, unless NO_COLOR is set (no-color.org) or TERM is "dumb".
class Paint {
 public:
  /// As fits what is written to this file descriptor.
  explicit Paint(int descriptor);
  /// For tests: on or off.
  explicit Paint(bool on) : on_(on) {}

  [[nodiscard]] std::string operator()(Colour colour, std::string_view text) const;

 private:
  bool on_;
};

/// Good for tracking, warning for initializing and degraded, bad for all else.
Colour colour_of_status(std::string_view status);

}  // namespace lilo
