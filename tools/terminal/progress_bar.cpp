// SPDX-License-Identifier: BSD-3-Clause
#include "tools/terminal/progress_bar.hpp"

#include "tools/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace lilo {
namespace {

constexpr std::size_t kWidest = 40;
constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr double kSettled_s = 1.0;  // before that a rate says nothing

std::size_t terminal_columns() {
  winsize window{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 ? window.ws_col : 80;
}

std::string bar(double part, std::size_t width) {
  const std::string filled(static_cast<std::size_t>(part * static_cast<double>(width)), '#');
  return fmt::format("[{:.<{}}] {:3.0f} %", filled, width, part * 100.0);
}

std::string time_left(double part, double first_part, double elapsed_s) {
  const double done = part - first_part;
  if (elapsed_s < kSettled_s || done <= 0.0) return {};
  const auto left_s = std::llround(elapsed_s * (1.0 - part) / done);
  if (left_s < 60) return fmt::format("  {} s left", left_s);
  if (left_s < 3600) return fmt::format("  {}:{:02} min left", left_s / 60, left_s % 60);
  return fmt::format("  {}:{:02} h left", left_s / 3600, left_s / 60 % 60);
}

std::string counted(const Progress& progress, double elapsed_s) {
  if (progress.count == 0) return progress.what;
  const double rate = static_cast<double>(progress.count) / std::max(elapsed_s, 1e-3);
  const std::string text = fmt::format("{} {}", progress.count, progress.what);
  return elapsed_s < kSettled_s ? text : fmt::format("{}, {:.3g}/s", text, rate);
}

}  // namespace

std::string progress_text(const Progress& progress, double first_part, double elapsed_s,
                          std::size_t columns) {
  const double part = std::clamp(progress.part, 0.0, 1.0);
  const std::string count = counted(progress, elapsed_s);
  std::string text = time_left(part, first_part, elapsed_s) + "  " + count;
  constexpr std::size_t kAroundBar = 9;  // brackets, percentage, the last column
  const std::size_t room = columns - std::min(columns, text.size() + kAroundBar);
  text = part > 0.0 ? bar(part, std::min(room, kWidest)) + text : count;
  text.resize(std::min(text.size(), columns - std::min<std::size_t>(columns, 1)));
  return text;
}

ProgressBar::ProgressBar() : visible_(isatty(STDERR_FILENO) != 0), start_ns_(monotonic_ns()) {}

ProgressBar::~ProgressBar() {
  if (visible_) std::fputs("\r\033[K", stderr);
}

bool ProgressBar::due() const { return visible_ && monotonic_ns() >= next_ns_; }

void ProgressBar::show(const Progress& progress) {
  if (!visible_) return;
  const std::int64_t now_ns = monotonic_ns();
  next_ns_ = now_ns + kPeriod_ns;
  // What the first look finds done soon after the start was not done since.
  if (first_part_ < 0.0) {
    first_part_ = progress.part;
    start_ns_ = now_ns;
  }
  const double elapsed_s = static_cast<double>(now_ns - start_ns_) * 1e-9;
  fmt::print(stderr, "\r\033[K{}",
             progress_text(progress, first_part_, elapsed_s, terminal_columns()));
  std::fflush(stderr);
}

}  // namespace lilo
