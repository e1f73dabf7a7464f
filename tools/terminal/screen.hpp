// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <termios.h>

namespace lilo {

/// The whole terminal, as long as the object lives: the alternate screen, no cursor, keys without
/// Enter. What was there before comes back with the destructor; Ctrl-C must reach it, so have
/// StopSignals. Ctrl-Z is off meanwhile: a stopped program could not restore anything.
class Screen {
 public:
  /// Throws std::runtime_error when standard output is no terminal.
  Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen();

  struct Size {
    std::size_t rows, columns;
  };
  /// Asked anew every time: windows change.
  [[nodiscard]] static Size size();

  /// Shows these lines from the top, and nothing below them. They must fit.
  static void draw(const std::string& lines);
  /// The key that was pressed, or 0.
  [[nodiscard]] static char key();

 private:
  termios before_{};
  bool has_keys_ = false;  // standard input is a terminal too
};

}  // namespace lilo
