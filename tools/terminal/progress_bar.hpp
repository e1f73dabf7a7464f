// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace lilo {

/// How far some work is.
struct Progress {
  double part = 0.0;        ///< in [0, 1]; 0 as well while nobody can know
  std::uint64_t count = 0;  ///< of what is worked on; 0: not shown
  std::string what;         ///< "scans"; without a count whatever is to be said
};

/// A bar on the terminal's error stream, with the time left and the rate; nothing at all where that
/// is no terminal. The only one: every command that takes its time has it.
class ProgressBar {
 public:
  ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< takes the bar away

  /// True ten times a second: then show() is worth its while.
  [[nodiscard]] bool due() const;
  void show(const Progress& progress);

 private:
  bool visible_;
  std::int64_t start_ns_, next_ns_ = 0;
  double first_part_ = -1.0;  // what was done before: work that goes on where it was stopped
};

/// The line: "[####......]  40 %  12 s left  400 scans, 33.3/s", in at most `columns` characters.
/// `first_part`: how much was done when the clock started. The time left comes after a second of
/// work; a bar of which nobody knows the end is left out.
std::string progress_text(const Progress& progress, double first_part, double elapsed_s,
                          std::size_t columns);

}  // namespace lilo
