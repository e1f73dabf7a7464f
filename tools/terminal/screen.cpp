// SPDX-License-Identifier: BSD-3-Clause
#include "tools/terminal/screen.hpp"

#include <cstdio>
#include <stdexcept>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

namespace lilo {
namespace {

// ECMA-48 and xterm: alternate screen, cursor, clear to the right or below.
constexpr const char* kEnter = "\033[?1049h\033[?25l";
constexpr const char* kLeave = "\033[?25h\033[?1049l";
constexpr const char* kHome = "\033[H";
constexpr const char* kRestOfLine = "\033[K";
constexpr const char* kRestOfScreen = "\033[J";

void write_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDOUT_FILENO, text.data(), text.size());
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

Screen::Screen() {
  if (isatty(STDOUT_FILENO) == 0)
    throw std::runtime_error("top: expected a terminal; lilo status --json is for programs");
  has_keys_ = tcgetattr(STDIN_FILENO, &before_) == 0;
  if (has_keys_) {
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    raw.c_cc[VSUSP] = _POSIX_VDISABLE;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  write_all(kEnter);
}

Screen::~Screen() {
  write_all(kLeave);
  if (has_keys_) tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
}

Screen::Size Screen::size() {
  winsize window{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_row == 0) return {24, 80};
  return {window.ws_row, window.ws_col};
}

// Line by line over what is there: clearing everything first would flicker.
void Screen::draw(const std::string& lines) {
  std::string out = kHome;
  for (const char c : lines) {
    if (c == '\n') out += kRestOfLine;
    if (c == '\n') out += '\r';
    out += c;
  }
  if (out.ends_with("\r\n")) out.resize(out.size() - 2);  // or the last line would scroll
  write_all(out + kRestOfScreen);
}

char Screen::key() {
  char key = 0;
  return isatty(STDIN_FILENO) != 0 && read(STDIN_FILENO, &key, 1) == 1 ? key : '\0';
}

}  // namespace lilo
