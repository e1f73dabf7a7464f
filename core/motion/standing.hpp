// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_prior.hpp"
#include "core/pose.hpp"

namespace lilo::core {

/// Whether the sensor stands, and the hypothesis that it still does.
///
/// Where most of what stands beside a standing sensor sets off slowly, as the lanes of a jam do, an
/// alignment that begins at the last pose and velocity goes along with it a little more every scan.
/// From the place where the sensor stood, what really stands fits exactly.
class Standing {
 public:
  void begin(const Pose& T_odom_sensor);  ///< It stands, or is taken to.
  void end();
  /// A pose was found, and the twist at its end.
  void observe(const Pose& T_odom_sensor, const Twist& twist);

  [[nodiscard]] bool is_likely() const { return stands_; }
  /// The prediction of a sensor that is where it stood, and hardly moves. What is known of rotation
  /// stays.
  [[nodiscard]] Prior hypothesis(Prior prior) const;

 private:
  Pose T_odom_sensor_;  // where it stood
  int still_scans_ = 0;
  bool stands_ = false;
};

}  // namespace lilo::core
