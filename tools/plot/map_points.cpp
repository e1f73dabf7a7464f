#include "tools/plot/map_points.hpp"

namespace lilo {
namespace {

constexpr double kTakeEvery_m = 0.5;
constexpr double kTakeEvery_rad = 0.1;
constexpr std::size_t kMostPoints = 6'000'000;
constexpr int kTimeSlots = 64;  // poses within a scan: 1.6 ms apart, 3 cm at 20 m/s

/// Poses of the sensor over one scan, T_odom_sensor.
std::vector<Pose> poses_within(const Scan& scan, const Pose& previous, std::int64_t previous_ns,
                               const Pose& pose) {
  std::vector<Pose> poses;
  poses.reserve(kTimeSlots + 1);
  const auto span_ns = static_cast<double>(scan.end_ns - previous_ns);
  for (int k = 0; k <= kTimeSlots; ++k) {
    const double before_end_ns =
        static_cast<double>(scan.end_ns - scan.start_ns) * (kTimeSlots - k) / kTimeSlots;
    const bool still = scan.motion_compensated || span_ns <= 0.0;
    poses.push_back(still ? pose : interpolate(previous, pose, 1.0 - before_end_ns / span_ns));
  }
  return poses;
}

}  // namespace

void MapPoints::add(const Scan& scan, const Pose& pose) {
  if (!any_) previous_ = pose;
  if (!any_ || worth_taking(pose)) {
    const std::int64_t since_ns = any_ ? previous_ns_ : scan.start_ns;
    const std::vector<Pose> poses = poses_within(scan, previous_, since_ns, pose);
    const double slot_ns = static_cast<double>(scan.end_ns - scan.start_ns) / kTimeSlots + 1.0;
    for (std::size_t k = 0; k < scan.returns.size(); k += stride_) {
      const Return& r = scan.returns[k];
      const auto slot = static_cast<std::size_t>(r.t_ns / slot_ns);
      const Eigen::Vector3d p = poses[slot] * Eigen::Vector3f(r.x_m, r.y_m, r.z_m).cast<double>();
      points_.emplace_back(p.cast<float>());
    }
    taken_ = pose;
    if (points_.size() > kMostPoints) thin_out();
  }
  any_ = true;
  previous_ = pose;
  previous_ns_ = scan.end_ns;
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
