// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace lilo {

/// Capture stamps to the moments at which the packets are due again. All due times are measured
/// from one anchor, so that errors of single sleeps never add up.
class Pacer {
 public:
  /// `speed` > 0: capture seconds played in one second. The first packet is due at `start_ns`.
  Pacer(double speed, std::int64_t start_ns) : speed_(speed), anchor_due_ns_(start_ns) {}

  /// Stamps that step back a little (two captures' threads) keep the schedule; those that step back
  /// by more than a second (files put one behind the other, a loop) go on where the last one ended,
  /// and so do those that step ahead by more than a minute: the recording computer's clock was set.
  std::int64_t due_ns(std::int64_t captured_ns) {
    const std::int64_t step_ns = captured_ns - last_captured_ns_;
    if (!anchored_ || step_ns < -kMaxStepBack_ns || step_ns > kMaxPause_ns) {
      anchor_due_ns_ = anchored_ ? last_due_ns_ : anchor_due_ns_;
      anchor_captured_ns_ = captured_ns;
      anchored_ = true;
    }
    last_captured_ns_ = captured_ns;
    const auto elapsed_ns = static_cast<double>(captured_ns - anchor_captured_ns_);
    last_due_ns_ = anchor_due_ns_ + static_cast<std::int64_t>(elapsed_ns / speed_);
    return last_due_ns_;
  }

  /// The next packet belongs to another run through the file: it is due with the last one.
  void restart() {
    anchor_due_ns_ = anchored_ ? last_due_ns_ : anchor_due_ns_;
    anchored_ = false;
  }

 private:
  static constexpr std::int64_t kMaxStepBack_ns = 1'000'000'000;
  static constexpr std::int64_t kMaxPause_ns = 60'000'000'000;

  double speed_;
  std::int64_t anchor_due_ns_;
  std::int64_t anchor_captured_ns_ = 0;
  std::int64_t last_captured_ns_ = 0;
  std::int64_t last_due_ns_ = 0;
  bool anchored_ = false;
};

}  // namespace lilo
