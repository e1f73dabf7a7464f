// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/pose.hpp"

#include <array>
#include <cstddef>

namespace lilo::core {

/// What the covariance of the map's drift grew by over the last 10 m of the way (kTrustedWay_m), or
/// up to a quarter or a scan's way more. Of a sensor that moves less, what the last kTrustedScans
/// added, or up to a quarter more. As in Drift: rotation then translation, in the odometry's axes
/// (rad, m). It is a difference of covariances: an error that is correlated with earlier ones
/// counts by how it changed the covariance, which may be less than zero after a turn back.
class RecentDrift {
 public:
  RecentDrift() { clear(); }
  /// Another map is begun.
  void clear();
  void grow(const Matrix6d& by) { parts_[newest_] += by; }
  /// Once for each scan: the sensor moved by so much; `F` takes a small motion about its old place
  /// to the same about the new one.
  void move(const Matrix6d& F, double way_m);
  [[nodiscard]] Matrix6d covariance() const;

 private:
  static constexpr int kParts = 4;  // and the one that begins
  static constexpr double kPart_m = tracking::kTrustedWay_m / kParts;
  static constexpr int kPartScans = tracking::kTrustedScans / kParts;

  [[nodiscard]] bool is_newest_full() const {
    return newest_m_ >= kPart_m || newest_scans_ >= kPartScans;
  }

  std::array<Matrix6d, kParts + 1> parts_;
  std::size_t newest_ = 0;
  double newest_m_ = 0.0;  // how far it reaches back
  int newest_scans_ = 0;
};

}  // namespace lilo::core
