// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/route.hpp"
#include "tools/sim/terrain.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lilo::sim {

struct MotionOptions {
  double speed_mps = 8.0;
  double duration_s = 30.0;
  bool start_in_motion = false;  ///< at speed from the first packet on
  double standstill_s = 1.0;     ///< before setting off (not with start_in_motion)
  double turn_rate_dps = 0.0;    ///< turns on top of the route's heading, as on a turntable
  double turn_ramp_s = 1.0;      ///< until it turns so fast
  double tilt_deg = 0.0;         ///< of the sensor on its mount, nose down
  double roll_deg = 0.0;         ///< then about its x, right side down; 180: upside down
  /// A wheel or a mast that shakes the body while it drives: pitch at this frequency, roll a little
  /// slower, and the root mean square of each one's rate.
  double shake_hz = 10.0, shake_dps = 0.0;
  std::uint64_t seed = 1;
};

/// The body that carries the sensor.
struct Vehicle {
  double wheelbase_m = 2.6;
  double track_m = 1.5;
  double sensor_height_m = 1.85;
  double lane_m = 0.0;                     ///< drives this far to the left of the route's line
  double wander_m = 0.25;                  ///< drifts about the lane by as much as this
  double lateral_acceleration_mps2 = 2.5;  ///< slows down before curves to stay below
};

/// How far along the route the vehicle is: accelerates, brakes before curves and before the route's
/// end, with continuous acceleration.
class Drive {
 public:
  Drive(const MotionOptions& options, const Vehicle& vehicle, const Route& route);

  [[nodiscard]] double arc_m(double time_s) const { return at(arc_, time_s); }
  [[nodiscard]] double speed_mps(double time_s) const { return at(speed_, time_s); }

  static constexpr double kLead_s = 1.0;  ///< times from -kLead_s to duration + kLead_s are defined
  static constexpr double kStep_s = 0.01;

 private:
  [[nodiscard]] static double at(const std::vector<double>& table, double time_s);

  std::vector<double> arc_, speed_;
};

/// The sensor's pose at every instant: each of x, y, z, yaw, pitch, roll is a uniform cubic
/// B-spline, so position and attitude have continuous velocity and acceleration. This function is
/// the truth; every shot and every ground-truth line asks it and nothing else.
class SensorPath {
 public:
  SensorPath(const MotionOptions& options, const Vehicle& vehicle, const Route& route,
             const Drive& drive, const Terrain& terrain);

  /// World from sensor, `time_s` after the recording's start.
  [[nodiscard]] Placement at(double time_s) const;

  static constexpr double kKnot_s = 0.02;

 private:
  using Channels = std::array<double, 6>;  ///< x, y, z, yaw, pitch, roll of the body at the sensor
  std::vector<Channels> controls_;
  Eigen::Matrix3d mount_;
};

}  // namespace lilo::sim
