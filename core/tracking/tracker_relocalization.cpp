#include "core/registration/weak_directions.hpp"
#include "core/tracking/tracker.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

/// How the tracker finds its place in the map again.
///
/// After a second without the sensor the prediction may be off by metres and tens of degrees,
/// farther than an alignment reaches, and yet some of the scan matches something: that an alignment
/// converged proves nothing. So all places within reach are looked for (relocalizer.hpp), the scan
/// is aligned from the best of them, and one is taken only where clearly more of what stands fits
/// than at any other. Else the sensor stays lost.
namespace lilo::core {
namespace {

// What a vehicle may change of its motion unseen.
constexpr double kAcceleration_mps2 = 4.0, kTurn_radps = 1.0;
// Alignments nearer to each other came to the same place.
constexpr double kSame_m = 1.0, kSame_rad = 0.1;

constexpr double kHalf = 0.5;     // of what fits usually
constexpr double kClearly = 2.0;  // sigmas

double count_of_structure(const std::vector<Feature>& features) {
  return static_cast<double>(std::count_if(features.begin(), features.end(), [](const Feature& f) {
    return f.kind == FeatureKind::structure;
  }));
}

// How well a place is known that was looked for, 1 sigma.
constexpr double kPlace_m = 0.5, kTurned_rad = 0.05;

bool is_within(const Pose& T, double along_m, double turned_rad) {
  return T.translation_m.norm() < along_m && so3_log(T.rotation).norm() < turned_rad;
}

}  // namespace

/// What part of the structure fits the map, against what did of late; 1 where the difference may
/// be chance.
double Tracker::relative_fit(const Solution& solution, const std::vector<Feature>& chosen) const {
  constexpr double kBeyondChance = 3.0;  // sigmas
  const double usual = usual_fit_ * count_of_structure(chosen), found = solution.structure_inliers;
  return usual - found > kBeyondChance * std::sqrt(usual) ? found / usual : 1.0;
}

void Tracker::learn_fit(const std::vector<Feature>& chosen) {
  constexpr double kNewest = 0.3;  // weight of a scan in the running mean: a few scans
  const double structure = count_of_structure(chosen);
  if (seen_count_ > 0 || structure < 1.0) return;
  const double fit = solution_.structure_inliers / structure;
  usual_fit_ += (usual_fit_ > 0.0 ? kNewest : 1.0) * (fit - usual_fit_);
}

/// Whether an alignment may be right: one that went astray lays hardly any structure on the map,
/// and mostly wanders about. What fits ever less, and well, is another kind of place.
bool Tracker::is_explained(const Solution& solution, const std::vector<Feature>& chosen) const {
  return relative_fit(solution, chosen) > (solution.converged ? kNothing : kHalf);
}

/// Where an alignment fits far worse than those before, the sensor may have begun to turn faster
/// than it can follow: such turns are looked for, and taken where clearly more fits.
Solution Tracker::follow_turn(const Solution& found, const std::vector<Feature>& chosen,
                              const Prior& prior) {
  // Where the last scan was doubtful as well, it may have gone astray already.
  constexpr Reach kSudden{0.0, 0.8, 0.0}, kSuddenBefore{0.0, 1.2, 0.4};
  if (seen_count_ > 0 || relative_fit(found, chosen) > kDoubtful) return found;
  const Trajectory predicted = solver_.unmoved(prior).trajectory;
  draw_map(predicted.end().translation_m);
  Solution best = found;
  for (const Displacement& by : relocalizer_.search(
           chosen, predicted, is_doubtful_ ? kSuddenBefore : kSudden, Change::during)) {
    const Solution other = solve_turned(by, chosen, prior);
    if (other.structure_inliers > best.structure_inliers) best = other;
  }
  const double sigma = std::sqrt(best.structure_inliers + found.structure_inliers);
  const bool is_better = best.structure_inliers - found.structure_inliers > kClearly * sigma;
  return is_better && is_explained(best, chosen) ? best : found;
}

/// Aligns a scan that began where it was predicted to, and ended displaced.
Solution Tracker::solve_turned(const Displacement& by, const std::vector<Feature>& chosen,
                               Prior prior) {
  constexpr double kRate_radps = 1.0, kSpeed_mps = 1.0;  // 1 sigma
  const Pose T_end = displaced(moved(prior.T_begin, prior.twist, prior.span_s), by);
  prior.T_begin = displaced(prior.T_begin, {by.along_m, by.begin_yaw_rad, by.begin_yaw_rad});
  prior.twist = twist_between(prior.T_begin, T_end, prior.span_s);
  Matrix6d of_pose = prior.begin_information.inverse().topLeftCorner<6, 6>();
  if (is_doubtful_) {
    of_pose.diagonal().head<3>().array() += kTurned_rad * kTurned_rad;
    of_pose.diagonal().tail<3>().array() += kPlace_m * kPlace_m;
  }
  prior.begin_information.setZero();
  prior.begin_information.topLeftCorner<6, 6>() = of_pose.inverse();
  prior.begin_information.diagonal().segment<3>(6).setConstant(1.0 / (kRate_radps * kRate_radps));
  prior.begin_information.diagonal().tail<3>().setConstant(1.0 / (kSpeed_mps * kSpeed_mps));
  return solver_.solve(chosen, maps_, prior, finest_);
}

/// Whether the sensor went unseen for longer than it can be looked for. The old map must not be
/// asked then: some place in it always looks like the new one.
bool Tracker::is_unsearchable() const {
  return scan_count_ > 1 && seen_count_ == 0 && unseen_s() > kSearchable_s;
}

/// When it was last aligned.
bool Tracker::stood() const {
  constexpr double kStill_mps = 0.1, kStill_radps = 0.03;
  return twist_.linear_mps.norm() < kStill_mps && twist_.angular_radps.norm() < kStill_radps;
}

/// Whether it is beyond doubt where it was predicted to be.
bool Tracker::is_in_place(const Solution& found, const Prior& prior,
                          const std::vector<Feature>& chosen) const {
  constexpr double kExactly_m = 0.2, kExactly_rad = 0.02, kAsEver = 0.8;
  const Pose T_end = moved(prior.T_begin, prior.twist, prior.span_s);
  return is_within(T_end.inverse() * found.trajectory.end(), kExactly_m, kExactly_rad) &&
         relative_fit(found, chosen) > kAsEver &&
         weak_directions(found.data_information, found.motion_information, T_end.rotation).count ==
             0;
}

/// Whether no more may be asked of the old map. That the clock was set is no reason: then the
/// sensor is where it was going to be. Who stood is waited for.
bool Tracker::is_gone(const std::vector<Feature>& chosen) {
  if (!is_unsearchable() || stood()) return false;
  const Prior prior = predict(timing_);
  return !is_in_place(solver_.solve(chosen, maps_, prior, finest_), prior, chosen);
}

/// From the last scan that was aligned to the beginning of this one. A clock that was set back
/// says as little as one that was set forward.
double Tracker::unseen_s() const {
  return 1e-9 * std::abs(static_cast<double>(timing_.start_ns - last_aligned_ns_));
}

bool Tracker::may_be_elsewhere() const {
  return scan_count_ > 1 && seen_count_ == 0 && unseen_s() > kUnseen_s;
}

/// The best alignment within reach, or the prediction if none is clearly the best.
Solution Tracker::relocalize(const Scan& scan, const std::vector<Feature>& chosen,
                             const Prior& prior) {
  attempt_everywhere(chosen, prior);
  Solution& best = *std::max_element(attempts_.data(), attempts_.data() + attempt_count_,
                                     [](const Solution& a, const Solution& b) {
                                       return a.structure_inliers < b.structure_inliers;
                                     });
  if (!stands_out(best)) return solver_.unmoved(prior);
  if (!best.converged) best = solve_from(best.trajectory.end(), chosen, prior);
  // Structure alone leaves height and tilt open.
  constexpr double kMinGround = 50.0;  // sum of robust weights
  const bool is_found = best.converged && best.inliers - best.structure_inliers > kMinGround &&
                        status_of(scan, best, chosen) != TrackingStatus::lost &&
                        relative_fit(best, chosen) > kHalf &&
                        (!is_unsearchable() || is_in_place(best, prior, chosen));
  return is_found ? best : solver_.unmoved(prior);
}

void Tracker::draw_map(const Eigen::Vector3d& center_m) {
  if (drawn_at_ns_ == last_aligned_ns_) return;  // since then it does not grow
  relocalizer_.set_map(maps_.at(LocalMaps::kCoarse, FeatureKind::structure), center_m);
  drawn_at_ns_ = last_aligned_ns_;
}

/// From where the scan was predicted to be, and from the likeliest places within reach of it.
void Tracker::attempt_everywhere(const std::vector<Feature>& chosen, const Prior& prior) {
  const Trajectory predicted = solver_.unmoved(prior).trajectory;
  const Pose T_end = predicted.end();
  const double time_s = unseen_s() + span_of(timing_);
  const Reach reach{0.5 * kAcceleration_mps2 * time_s * time_s, kTurn_radps * time_s, 0.0};
  draw_map(T_end.translation_m);
  attempts_[0] = solver_.solve(chosen, maps_, prior, finest_);
  attempt_count_ = 1;
  for (const Displacement& by : relocalizer_.search(chosen, predicted, reach)) {
    const Solution solution = solve_from(displaced(T_end, by), chosen, prior);
    if (is_within(T_end.inverse() * solution.trajectory.end(), reach.along_m + kSame_m,
                  reach.yaw_rad + kSame_rad)) {
      attempts_[attempt_count_++] = solution;
    }
  }
}

/// Aligns a scan that ended about there; of its motion nothing is known.
Solution Tracker::solve_from(const Pose& T_end, const std::vector<Feature>& chosen, Prior prior) {
  prior.T_begin = moved(T_end, prior.twist, -prior.span_s);
  prior.begin_information = first_information();
  prior.begin_information.diagonal().head<3>().setConstant(1.0 / (kTurned_rad * kTurned_rad));
  prior.begin_information.diagonal().segment<3>(3).setConstant(1.0 / (kPlace_m * kPlace_m));
  return solver_.solve(chosen, maps_, prior, finest_);
}

/// Whether nearly as much fits nowhere else.
bool Tracker::stands_out(const Solution& best) const {
  const Pose back = best.trajectory.end().inverse();
  return std::all_of(
      attempts_.data(), attempts_.data() + attempt_count_, [&](const Solution& other) {
        const double sigma = std::sqrt(best.structure_inliers + other.structure_inliers);
        return is_within(back * other.trajectory.end(), kSame_m, kSame_rad) ||
               best.structure_inliers - other.structure_inliers > kClearly * sigma;
      });
}

}  // namespace lilo::core
