// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/metrics.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

/// D of the header.
Pose motion_error(const Matched& poses, std::size_t i, std::size_t j) {
  const Pose estimated = poses.estimate[i].inverse() * poses.estimate[j];
  const Pose actual = poses.truth[i].inverse() * poses.truth[j];
  return estimated.inverse() * actual;
}

double angle_deg(const Pose& T) { return so3_log(T.rotation).norm() * kDegreesPerRadian; }

ErrorSummary summarize(const std::vector<double>& errors) {
  ErrorSummary summary;
  for (const double error : errors) {
    summary.mean += error;
    summary.rmse += error * error;
    summary.max = std::max(summary.max, error);
  }
  const auto count = static_cast<double>(errors.size());
  summary.mean /= count;
  summary.rmse = std::sqrt(summary.rmse / count);
  return summary;
}

/// Sums until finish(), means afterwards.
struct SegmentSum {
  SegmentError error;

  void add(const Pose& D, double length_m) {
    ++error.count;
    error.t_percent += D.translation_m.norm() / length_m * 100.0;
    error.r_deg_per_100m += angle_deg(D) / length_m * 100.0;
  }
  [[nodiscard]] SegmentError finish() const {
    SegmentError mean = error;
    mean.t_percent /= error.count;
    mean.r_deg_per_100m /= error.count;
    return mean;
  }
};

Eigen::Matrix3Xd positions(const std::vector<Pose>& poses) {
  Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    result.col(static_cast<Eigen::Index>(k)) = poses[k].translation_m;
  }
  return result;
}

}  // namespace

SegmentErrors segment_errors(const Matched& poses, const std::vector<double>& lengths_m, int step) {
  const std::vector<double> distance = travelled_m(poses.truth);
  SegmentErrors errors;
  SegmentSum all;
  for (const double length_m : lengths_m) {
    SegmentSum sum{{.length_m = length_m}};
    for (std::size_t i = 0; i < distance.size(); i += static_cast<std::size_t>(step)) {
      const auto end = std::upper_bound(distance.begin() + static_cast<std::ptrdiff_t>(i),
                                        distance.end(), distance[i] + length_m);
      if (end == distance.end()) break;  // later starts have even less road left
      const Pose D = motion_error(poses, i, static_cast<std::size_t>(end - distance.begin()));
      sum.add(D, length_m);
      all.add(D, length_m);
    }
    if (sum.error.count > 0) errors.per_length.push_back(sum.finish());
  }
  if (all.error.count > 0) errors.overall = all.finish();
  return errors;
}

std::vector<double> default_lengths_m(double path_m) {
  const double unit_m = path_m > 100.0 ? 100.0 : path_m > 10.0 ? 10.0 : 1.0;
  std::vector<double> lengths_m;
  for (int k = 1; k <= 8 && k * unit_m < path_m; ++k) lengths_m.push_back(k * unit_m);
  return lengths_m;
}

ErrorSummary absolute_error_m(const Matched& poses) {
  const Eigen::Matrix3Xd estimate = positions(poses.estimate);
  const Eigen::Matrix3Xd truth = positions(poses.truth);
  const Eigen::Matrix4d T = Eigen::umeyama(estimate, truth, false);
  const Eigen::Matrix3Xd aligned =
      (T.topLeftCorner<3, 3>() * estimate).colwise() + T.topRightCorner<3, 1>().eval();
  const Eigen::VectorXd errors = (aligned - truth).colwise().norm();
  return summarize({errors.begin(), errors.end()});
}

RelativeError relative_error(const Matched& poses) {
  std::vector<double> translation_m, rotation_deg;
  for (std::size_t i = 0; i + 1 < poses.truth.size(); ++i) {
    const Pose D = motion_error(poses, i, i + 1);
    translation_m.push_back(D.translation_m.norm());
    rotation_deg.push_back(angle_deg(D));
  }
  return {summarize(translation_m), summarize(rotation_deg)};
}

Closure closure(const Matched& poses) {
  const Pose D = motion_error(poses, 0, poses.truth.size() - 1);
  return {
      .estimate_m =
          (poses.estimate.back().translation_m - poses.estimate.front().translation_m).norm(),
      .truth_m = (poses.truth.back().translation_m - poses.truth.front().translation_m).norm(),
      .error_m = D.translation_m.norm(),
      .error_deg = angle_deg(D),
  };
}

}  // namespace lilo
