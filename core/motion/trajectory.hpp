// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/sensitivity.hpp"
#include "core/constants.hpp"
#include "core/estimate.hpp"
#include "core/pose.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>

/// The motion of the sensor during one scan, as a smooth deviation from constant velocity.
///
/// White noise on acceleration makes a cubic between knots (Barfoot, State Estimation for Robotics,
/// ch. 11): a knot holds the deviation d (rotation, translation; odometry axes) from the predicted
/// motion and its rate, and between two knots the deviation is their Hermite cubic. Position and
/// velocity are continuous inside a scan and from scan to scan.
namespace lilo::core {

inline constexpr int kKnotSize = 12;  ///< d (rotation, translation), then its rate per second
inline constexpr int kMaxUnknowns = kKnotSize * (motion::kMaxSegments + 1);
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxUnknowns, 1>;
using Knot = Eigen::Matrix<double, kKnotSize, 1>;
using KnotInformation = Eigen::Matrix<double, kKnotSize, kKnotSize>;

struct Trajectory {
  Pose T_begin;         ///< predicted pose of the first firing
  Twist twist;          ///< predicted twist, in the moving frame
  double span_s = 0.1;  ///< first to last firing
  int segments = 1;
  Unknowns knots;  ///< segments + 1 knots; zero: constant velocity

  /// Pose at the part `s` of the span, in [0, 1].
  [[nodiscard]] Pose at(double s) const;
  [[nodiscard]] Pose end() const { return at(1.0); }
  /// Twist of the last firing, in the sensor's frame.
  [[nodiscard]] Twist end_twist() const;
};

/// d(s) is the sum of `weight[k]` times six-vector k, counted from `first`: d and rate of the knot
/// before, d and rate of the knot after.
struct KnotWeights {
  int first;  ///< index of the knot before
  std::array<double, 4> weight;
};
KnotWeights weights_at(double s, int segments, double span_s);

/// The pose after `dt_s` at constant twist.
Pose moved(const Pose& T, const Twist& twist, double dt_s);

/// The constant twist from `a` to `b` in `dt_s`, in the frame of `a`.
Twist twist_between(const Pose& a, const Pose& b, double dt_s);

/// The trajectory at evenly spaced instants, laid out for the point loop. Rotation is taken from
/// the nearest instant (within 0.4 ms of a 100 ms scan), translation changes linearly around it.
struct Sampled {
  template <typename T>
  using AtInstants = std::array<T, motion::kTrajectoryInstants + 1>;
  AtInstants<Eigen::Matrix3f> rotation;
  AtInstants<Eigen::Vector3d> translation_m;
  AtInstants<Eigen::Vector3d> velocity;  ///< change of translation per unit of s

  /// A point of the sensor's frame at the part `s` of the scan, turned into the odometry's axes;
  /// and the origin of that frame.
  [[nodiscard]] Eigen::Vector3f turn(float s, const Eigen::Vector3f& p) const {
    return rotation[instant_of(s)] * p;
  }
  [[nodiscard]] Sensitivity turn_columns(float s, const Sensitivity& p) const {
    return rotation[instant_of(s)] * p;
  }
  [[nodiscard]] Eigen::Vector3d origin_m(float s) const {
    const std::size_t k = instant_of(s);
    return translation_m[k] +
           (static_cast<double>(s) - static_cast<double>(k) / motion::kTrajectoryInstants) *
               velocity[k];
  }
  static std::size_t instant_of(float s) {
    const float and_half = s * motion::kTrajectoryInstants + 0.5F;  // lround() is a call
    return static_cast<std::size_t>(and_half);
  }
};
void sample(const Trajectory& trajectory, Sampled& sampled);

}  // namespace lilo::core
