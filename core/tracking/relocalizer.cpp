// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/relocalizer.hpp"

#include "core/constants.hpp"
#include "core/registration/weak_directions.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace lilo::core {
namespace {

double inverse_square(double sigma) { return 1.0 / (sigma * sigma); }

bool fits_less(const Solution& a, const Solution& b) {
  return a.structure_inliers < b.structure_inliers;
}

bool fits_significantly_better(const Solution& a, const Solution& b) {
  return is_significant(a.structure_inliers, b.structure_inliers, search::kPreferSigmas);
}

double ground_inliers(const Solution& solution) {
  return solution.inliers - solution.structure_inliers;
}

/// The prior of a scan that ended about there, with an unknown motion.
Prior prior_at(const Pose& T_end, Prior prior) {
  prior.T_begin = moved(T_end, prior.twist, -prior.span_s);
  prior.begin_information = initial_information();
  prior.begin_information.diagonal().head<3>().setConstant(
      inverse_square(tracking::kFoundPlace_rad));
  prior.begin_information.diagonal().segment<3>(3).setConstant(
      inverse_square(tracking::kFoundPlace_m));
  return prior;
}

/// The prior of a scan that began as predicted and ended displaced.
Prior prior_turned(const Displacement& by, bool may_begin_elsewhere, Prior prior) {
  const Pose T_end = displaced(predicted_end(prior), by);
  prior.T_begin = displaced(prior.T_begin, {by.along_m, by.begin_yaw_rad, by.begin_yaw_rad});
  prior.twist = twist_between(prior.T_begin, T_end, prior.span_s);
  Matrix6d of_pose = prior.begin_information.inverse().topLeftCorner<6, 6>();
  if (may_begin_elsewhere) {
    of_pose.diagonal().head<3>().array() += tracking::kFoundPlace_rad * tracking::kFoundPlace_rad;
    of_pose.diagonal().tail<3>().array() += tracking::kFoundPlace_m * tracking::kFoundPlace_m;
  }
  prior.begin_information.setZero();
  prior.begin_information.topLeftCorner<6, 6>() = of_pose.inverse();
  prior.begin_information.diagonal().segment<3>(6).setConstant(
      inverse_square(search::kMostYawRate_radps));
  prior.begin_information.diagonal().tail<3>().setConstant(
      inverse_square(search::kSearchedVelocity_mps));
  return prior;
}

}  // namespace

bool is_in_place(const Solution& found, const Prior& prior, double relative_fit) {
  const Pose T_end = predicted_end(prior);
  return magnitude_m(T_end.inverse() * found.trajectory.end()) < tracking::kInPlace_m &&
         relative_fit >= 1.0 &&
         weak_directions(found.data_information, found.motion_information, T_end.rotation).count ==
             0;
}

void Relocalizer::draw_map(const Eigen::Vector3d& center_m, const LocalOdometry& local) {
  if (drawn_revision_ == local.map().revision()) return;
  search_.set_map(local.map().cells().at(LocalMaps::kCoarse, FeatureKind::structure), center_m);
  drawn_revision_ = local.map().revision();
}

std::optional<Solution> Relocalizer::find(const Observation& scan, const Prior& prior,
                                          const Solution& at_prediction,
                                          const AlignmentHistory& history, LocalOdometry& local) {
  attempt_all(scan, prior, at_prediction, history, local);
  const auto all = attempts();
  Solution& best = *std::max_element(all.begin(), all.end(), fits_less);
  if (!is_unambiguous(best)) return std::nullopt;
  if (!best.converged) {
    best = local.align(*scan.features, prior_at(best.trajectory.end(), prior), scan.levels);
  }
  const bool is_found = best.converged && ground_inliers(best) > tracking::kMinGround &&
                        history.fit.relative(best, scan.structure) > registration::kDoubtfulFit;
  return is_found ? std::optional(best) : std::nullopt;
}

/// Aligns the scan from the predicted place and from the most likely places around it.
void Relocalizer::attempt_all(const Observation& scan, const Prior& prior,
                              const Solution& at_prediction, const AlignmentHistory& history,
                              LocalOdometry& local) {
  const Trajectory predicted = local.unaligned(prior).trajectory;
  const Pose T_end = predicted.end();
  const double time_s = history.unseen_s(scan.timing) + scan.timing.span_s();
  const SearchRadius radius{0.5 * search::kMostAcceleration_mps2 * time_s * time_s,
                            search::kMostYawRate_radps * time_s, 0.0};
  draw_map(T_end.translation_m, local);
  attempts_[0] = at_prediction;
  attempt_count_ = 1;
  for (const Displacement& by : search_.find(*scan.features, predicted, radius)) {
    const Solution solution =
        local.align(*scan.features, prior_at(displaced(T_end, by), prior), scan.levels);
    const Pose departed = T_end.inverse() * solution.trajectory.end();
    if (departed.translation_m.norm() < radius.along_m + search::kSamePlace_m &&
        so3_log(departed.rotation).norm() < radius.yaw_rad + search::kSamePlace_rad) {
      attempts_[attempt_count_++] = solution;
    }
  }
}

/// Whether significantly less fits at every other place.
bool Relocalizer::is_unambiguous(const Solution& best) const {
  const Pose back = best.trajectory.end().inverse();
  return std::all_of(attempts_.data(), attempts_.data() + attempt_count_,
                     [&](const Solution& other) {
                       return magnitude_m(back * other.trajectory.end()) < search::kSamePlace_m ||
                              fits_significantly_better(best, other);
                     });
}

Solution Relocalizer::follow_turn(const Solution& found, const Observation& scan,
                                  const Prior& prior, const AlignmentHistory& history,
                                  LocalOdometry& local) {
  if (history.fit.relative(found, scan.structure) > registration::kDoubtfulFit) return found;
  const SearchRadius within_scan{.yaw_rad = tracking::kSuddenTurn_rad};
  const SearchRadius since_last{.yaw_rad = tracking::kEarlierTurn_rad,
                                .begin_yaw_rad = tracking::kTurnedBefore_rad};
  std::optional<Solution> turned;
  if (!history.is_doubtful) {
    turned = better_turned(found, scan, prior, history, within_scan, local);
  }
  // A turn that began at the very end of the last scan left that one fitting well.
  if (!turned) turned = better_turned(found, scan, prior, history, since_last, local);
  return turned.value_or(found);
}

/// The best alignment from the most likely turns, if significantly more of the structure fits than
/// in `found`. Not taken are those that left the predicted place, which are no turns, and those in
/// which significantly less of the ground fits. Of the little structure on bare hills more may fit
/// by chance under some turn.
std::optional<Solution> Relocalizer::better_turned(const Solution& found, const Observation& scan,
                                                   const Prior& prior,
                                                   const AlignmentHistory& history,
                                                   const SearchRadius& radius,
                                                   LocalOdometry& local) {
  const Trajectory predicted = local.unaligned(prior).trajectory;
  draw_map(predicted.end().translation_m, local);
  const bool may_begin_elsewhere = radius.begin_yaw_rad > 0.0;
  const Eigen::Vector3d place_m = predicted.end().translation_m;
  Solution best = found;
  for (const Displacement& by :
       search_.find(*scan.features, predicted, radius, Onset::within_scan)) {
    const Solution other =
        local.align(*scan.features, prior_turned(by, may_begin_elsewhere, prior), scan.levels);
    const double departed_m = (other.trajectory.end().translation_m - place_m).norm();
    const bool loses_ground =
        is_significant(ground_inliers(found), ground_inliers(other), search::kPreferSigmas);
    if (departed_m < tracking::kFoundPlace_m && !loses_ground && fits_less(best, other)) {
      best = other;
    }
  }
  const bool is_better = fits_significantly_better(best, found) &&
                         is_explained(best, history.fit.relative(best, scan.structure));
  return is_better ? std::optional(best) : std::nullopt;
}

}  // namespace lilo::core
