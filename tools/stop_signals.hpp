// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lilo {

/// Turns Ctrl-C and `kill` into something a loop can ask for, so that it ends in good order. Make
/// one before any thread is started; the signals stay blocked until it goes.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  /// True from the first such signal on.
  [[nodiscard]] bool raised();
  /// Becomes readable with the signal; for poll().
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
  bool raised_ = false;
};

}  // namespace lilo
