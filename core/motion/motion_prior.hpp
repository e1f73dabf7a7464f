// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/trajectory.hpp"
#include "core/pose.hpp"

#include <Eigen/Core>

/// What is known of a scan's motion before its returns are used: it continues the motion of the
/// last scan, with white noise on acceleration (Barfoot, State Estimation for Robotics, ch. 11).
///
/// Process noise enters the alignment here and nowhere else; PoseUncertainty takes it for dead
/// reckoning and for gaps that are not predicted (covariance_over_gap()), and what was observed of
/// it at the start for the first scan. ProcessNoise estimates its density from the motion found;
/// predict() puts that into a Prior; the solver takes add_prior(), which inflates it where the
/// motion departs from the prior, and motion_information(). The pose that is reported has a density
/// of its own.
namespace lilo::core {

/// J'OJ over all knots.
using NormalMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxUnknowns, kMaxUnknowns>;

struct Prior {
  Pose T_begin;
  Twist twist;
  double span_s = 0.1;
  /// Seconds of the gap before the scan, if it is longer than motion::kLongestGap_s; else 0.
  double unpredicted_s = 0.0;
  int segments = 1;                ///< of the trajectory, up to motion::kMaxSegments
  Knot begin_mean = Knot::Zero();  ///< of the first knot
  KnotInformation begin_information = KnotInformation::Identity();
  /// Power density of acceleration, rotation (rad^2/s^3) and translation (m^2/s^3).
  Vector6d acceleration_density = Vector6d::Ones();
  /// The same for the pose that is reported (ProcessNoise::reported_density()).
  Vector6d reported_density = Vector6d::Ones();
};

/// Adds what is known of the velocity at the beginning besides the last scan: `velocity_mps` with
/// `information` (s^2/m^2), both along the odometry's axes.
void observe_velocity(Prior& prior, const Eigen::Vector3d& velocity_mps,
                      const Eigen::Vector3d& information);

/// The mean over the axes (rotation, translation) that share their process noise. Roll and pitch
/// share one, and so do the two axes of the ground plane; yaw and height have their own.
Vector6d mean_by_kind(const Vector6d& of_axes);

/// Adds the prior to the normal equations H step = b of the deviation `x`. Its process noise is
/// inflated by the normalised innovation of `x`: the prior has heavy tails.
void add_prior(const Prior& prior, const Unknowns& x, NormalMatrix& H, Unknowns& b);

/// Normalised innovation squared of the motion `x`: how far it departs from a constant velocity, as
/// a mean square in sigmas of the prior, the same for axes that share their process noise. Where
/// the prior is right it is 1 or, since the weight of residuals is reduced, less.
Vector6d normalised_innovation(const Prior& prior, const Unknowns& x);

/// The prior with its process noise inflated until such an innovation is no more than expected.
/// That makes it a prior with heavy tails: an unexpected motion is followed within the same scan.
Prior inflated(Prior prior, const Vector6d& innovation);

/// Information of the change between two knots `dt_s` apart under white noise on acceleration:
/// inverse of Q = [dt^3/3 Qc, dt^2/2 Qc; dt^2/2 Qc, dt Qc].
KnotInformation process_information(const Vector6d& acceleration_density, double dt_s);

/// Information of the pose at the end of a scan whose beginning is known exactly. A scan shorter
/// than motion::kComparedSpan_s has fewer returns. It is compared with its part of that at the end
/// of a scan of that span: over a shorter time the motion model is ever more certain, and at 1200
/// revolutions a minute almost every scan would tell less.
Matrix6d motion_information(const Prior& prior);

/// The number of segments in a span: as many as keep the motion between two knots certain to
/// motion::kKnotMotion_rad (1 sigma). Halfway between two known knots, white noise of density q on
/// acceleration leaves a variance of q dt^3 / 192. At least `least`, at most motion::kMaxSegments.
int segments_for(const Vector6d& acceleration_density, double span_s, int least);

/// The information of a knot left after `dt_s` without data.
KnotInformation propagated(const KnotInformation& information, const Vector6d& acceleration_density,
                           double dt_s);

}  // namespace lilo::core
