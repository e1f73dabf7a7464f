// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/trajectory.hpp"
#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <span>

/// The points by which the tracker aligned a scan, and those that it mapped.
namespace lilo::core {
namespace {

/// Calls `take(index)` for `most` of `size` things, spread evenly over all of them. A stride of the
/// golden ratio never falls into step with the rings, as every k-th in the order of the image
/// would.
template <typename Take>
void take_evenly(std::size_t size, std::size_t most, const Take& take) {
  const std::size_t stride = Selection::golden_stride(size);
  const std::size_t count = std::min(size, most);
  for (std::size_t n = 0, at = 0; n < count; ++n, at = (at + stride) % size) take(at);
}

}  // namespace

void Tracker::aligned_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const {
  out.clear();
  const std::vector<Feature>& chosen = selection_.chosen();
  const Trajectory& trajectory = alignment_.solution.trajectory;
  if (trajectory.knots.size() == 0) return;  // before the first scan
  // The reported pose takes them to the map. Where the alignment was not accepted, the prediction
  // is reported, and they are as they were measured.
  const bool is_accepted = !is_lost() || alignment_.is_refuted;
  const Pose T_end_odom =
      (is_accepted ? alignment_.solution.reported.T_odom_sensor : trajectory.end()).inverse();
  const Eigen::Matrix3f turned_back = T_end_odom.rotation.toRotationMatrix().cast<float>();
  Sampled sampled;
  sample(trajectory, sampled);
  take_evenly(chosen.size(), most, [&](std::size_t at) {
    const Feature& f = chosen[at];
    const Eigen::Vector3f origin_m = (T_end_odom * sampled.origin_m(f.s)).cast<float>();
    out.emplace_back(turned_back * sampled.turn(f.s, {f.x_m, f.y_m, f.z_m}) + origin_m);
  });
}

void Tracker::mapped_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const {
  out.clear();
  const std::span<const LocalMaps::Point> inserted = local_.map().inserted();
  const Pose T_sensor_odom = local_.reported().T_odom_sensor.inverse();
  take_evenly(inserted.size(), most, [&](std::size_t at) {
    out.emplace_back((T_sensor_odom * inserted[at].point_m).cast<float>());
  });
}

}  // namespace lilo::core
