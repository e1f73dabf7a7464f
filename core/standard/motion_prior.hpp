#pragma once

#include "core/pose.hpp"
#include "core/standard/trajectory.hpp"

#include <Eigen/Core>

/// What is believed of a scan's motion before its returns are looked at: that it goes on from the
/// last scan's, with white noise on acceleration (Barfoot, State Estimation for Robotics, ch. 11).
namespace lilo::standard {

/// J'OJ over all knots.
using NormalMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxUnknowns, kMaxUnknowns>;

struct Prior {
  Pose T_begin;
  Twist twist;
  double span_s = 0.1;
  Knot begin_mean = Knot::Zero();  ///< of the first knot
  KnotInformation begin_information = KnotInformation::Identity();
  /// Power density of acceleration, rotation (rad^2/s^3) and translation (m^2/s^3).
  Vector6d acceleration_density = Vector6d::Ones();
  Vector6d wildest_density = Vector6d::Ones();  ///< the most that may be learnt
};

/// The kinds of unrest that differ from vehicle to vehicle and road to road: rocking (roll and
/// pitch), heaving (height).
inline constexpr int kUnrests = 2;
using PerUnrest = Eigen::Matrix<double, kUnrests, 1>;
using EndByUnrest = Eigen::Matrix<double, 6, kUnrests>;
using UnrestPull = Eigen::Matrix<double, Eigen::Dynamic, kUnrests, 0, kMaxUnknowns, kUnrests>;

/// 1 where a kind of unrest moves an axis (rotation, translation), else 0.
Eigen::Matrix<double, 6, kUnrests> unrest_axes();

/// Adds the prior to the normal equations H step = b of the deviation `x`.
void add_prior(const Prior& prior, int segments, const Unknowns& x, NormalMatrix& H, Unknowns& b);

/// Mean square, in sigmas of the prior, of how the motion `x` departs from a constant velocity, by
/// kind of unrest. Where the prior is right it is 1, or less: data count for less than they say.
PerUnrest surprise_of(const Prior& prior, int segments, const Unknowns& x);

/// The prior with so much more unrest that such a motion is no surprise: its tails are heavy.
Prior loosened(Prior prior, const PerUnrest& surprise);

/// How the right-hand side at the solution `x` changes by the logarithm of each unrest's density:
/// the more of it is believed in, the weaker the pull to a constant velocity. Solved by the normal
/// matrix it says where the solution would go.
UnrestPull pull_of_unrest(const Prior& prior, int segments, const Unknowns& x);

/// Where the scan would begin if the wildest motion were believed in: by the prior, at the
/// deviation `x`, and the normal equations H step = b of its data alone.
Vector6d wildest_begin(Prior prior, int segments, const Unknowns& x, NormalMatrix H, Unknowns b);

/// Information of the change between two knots `dt_s` apart under white noise on acceleration:
/// inverse of Q = [dt^3/3 Qc, dt^2/2 Qc; dt^2/2 Qc, dt Qc].
KnotInformation process_information(const Vector6d& acceleration_density, double dt_s);

/// The information of a knot left after `dt_s` without data.
KnotInformation propagated(const KnotInformation& information, const Vector6d& acceleration_density,
                           double dt_s);

}  // namespace lilo::standard
