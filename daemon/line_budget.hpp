// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace lilo {

/// So many lines in so long, then silence until the time is over. One thread.
class LineBudget {
 public:
  LineBudget(int lines, std::int64_t interval_ns) : lines_(lines), interval_ns_(interval_ns) {}

  /// Whether a line may be written now.
  bool take(std::int64_t now_ns) {
    if (used_ == 0 || now_ns - began_ns_ >= interval_ns_) {
      began_ns_ = now_ns;
      used_ = 0;
    }
    if (used_ < lines_) {
      ++used_;
      return true;
    }
    ++left_out_;
    return false;
  }
  /// Lines refused since this was last asked.
  std::uint64_t take_left_out() {
    const std::uint64_t lines = left_out_;
    left_out_ = 0;
    return lines;
  }

 private:
  int lines_;
  std::int64_t interval_ns_;
  std::int64_t began_ns_ = 0;
  int used_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace lilo
