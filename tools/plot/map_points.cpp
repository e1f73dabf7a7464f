// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/map_points.hpp"

namespace lilo {
namespace {

constexpr double kTakeEvery_m = 0.5;
constexpr double kTakeEvery_rad = 0.1;
constexpr std::size_t kMostPoints = 6'000'000;

}  // namespace

void MapPoints::add(const Scan& scan, const Pose& pose) {
  placer_.next(scan, pose);
  if (!any_ || worth_taking(pose)) {
    for (std::size_t k = 0; k < scan.returns.size(); k += stride_)
      points_.emplace_back(placer_.place(scan.returns[k]).cast<float>());
    taken_ = pose;
    if (points_.size() > kMostPoints) thin_out();
  }
  any_ = true;
}

bool MapPoints::worth_taking(const Pose& pose) const {
  const Pose moved = taken_.inverse() * pose;
  return moved.translation_m.norm() > kTakeEvery_m ||
         so3_log(moved.rotation).norm() > kTakeEvery_rad;
}

void MapPoints::thin_out() {
  stride_ *= 2;
  for (std::size_t k = 0; 2 * k < points_.size(); ++k) points_[k] = points_[2 * k];
  points_.resize((points_.size() + 1) / 2);
}

}  // namespace lilo
