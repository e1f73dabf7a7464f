#include "tools/progress_bar.hpp"

#include "tools/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace lilo {
namespace {

constexpr int kWidth = 40;
constexpr std::int64_t kPeriod_ns = 100'000'000;

}  // namespace

std::string progress_text(double part, int width) {
  const double clamped = std::clamp(part, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(clamped * width);
  const std::string bar(filled, '#');
  return fmt::format("[{:.<{}}] {:3.0f} %", bar, width, clamped * 100.0);
}

ProgressBar::ProgressBar() : visible_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (visible_) std::fputs("\r\033[K", stderr);
}

bool ProgressBar::due() const { return visible_ && monotonic_ns() >= next_ns_; }

void ProgressBar::show(double part, const std::string& note) {
  if (!visible_) return;
  next_ns_ = monotonic_ns() + kPeriod_ns;
  fmt::print(stderr, "\r\033[K{}  {}", progress_text(part, kWidth), note);
  std::fflush(stderr);
}

}  // namespace lilo
