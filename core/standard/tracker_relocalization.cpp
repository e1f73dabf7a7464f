#include "core/standard/tracker.hpp"

#include <algorithm>
#include <cmath>

/// How the tracker finds its place in the map again.
///
/// After a second without the sensor the prediction may be off by metres and tens of degrees,
/// farther than an alignment reaches, and yet some of the scan matches something: that an alignment
/// converged proves nothing. So all places within reach are looked for (relocalizer.hpp), the scan
/// is aligned from the best of them, and one is taken only where clearly more of what stands fits
/// than at any other. Else the sensor stays lost.
namespace lilo::standard {
namespace {

// What a vehicle may change of its motion unseen.
constexpr double kAcceleration_mps2 = 4.0, kTurn_radps = 1.0;
// Alignments nearer to each other came to the same place.
constexpr double kSame_m = 1.0, kSame_rad = 0.1;

bool is_within(const Pose& T, double along_m, double turned_rad) {
  return T.translation_m.norm() < along_m && so3_log(T.rotation).norm() < turned_rad;
}

}  // namespace

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
                        status_of(scan, best, chosen.size()) != TrackingStatus::lost;
  return is_found ? best : solver_.unmoved(prior);
}

/// From where the scan was predicted to be, and from the likeliest places within reach of it.
void Tracker::attempt_everywhere(const std::vector<Feature>& chosen, const Prior& prior) {
  const Trajectory predicted = solver_.unmoved(prior).trajectory;
  const Pose T_end = predicted.end();
  const double time_s = unseen_s() + span_of(timing_);
  const Reach reach{0.5 * kAcceleration_mps2 * time_s * time_s, kTurn_radps * time_s};
  if (drawn_at_ns_ != last_aligned_ns_) {  // since then it does not grow
    relocalizer_.set_map(maps_.at(LocalMaps::kCoarse, Kind::structure), T_end.translation_m);
    drawn_at_ns_ = last_aligned_ns_;
  }
  attempts_[0] = solver_.solve(chosen, maps_, prior);
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
  constexpr double kPlace_m = 0.5, kTurned_rad = 0.05;  // 1 sigma
  prior.T_begin = moved(T_end, prior.twist, -prior.span_s);
  prior.begin_information = first_information();
  prior.begin_information.diagonal().head<3>().setConstant(1.0 / (kTurned_rad * kTurned_rad));
  prior.begin_information.diagonal().segment<3>(3).setConstant(1.0 / (kPlace_m * kPlace_m));
  return solver_.solve(chosen, maps_, prior);
}

/// Whether nearly as much fits nowhere else.
bool Tracker::stands_out(const Solution& best) const {
  constexpr double kClearly = 2.0;  // sigmas
  const Pose back = best.trajectory.end().inverse();
  return std::all_of(
      attempts_.data(), attempts_.data() + attempt_count_, [&](const Solution& other) {
        const double sigma = std::sqrt(best.structure_inliers + other.structure_inliers);
        return is_within(back * other.trajectory.end(), kSame_m, kSame_rad) ||
               best.structure_inliers - other.structure_inliers > kClearly * sigma;
      });
}

}  // namespace lilo::standard
