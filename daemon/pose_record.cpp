// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pose_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lilo {

void PoseRecord::add(std::int64_t stamp_ns, const Pose& pose) {
  if (capacity_ == 0) return;
  const RecordedPose recorded{stamp_ns, pose.translation_m, pose.rotation.cast<float>()};
  if (poses_.size() < capacity_) {
    poses_.push_back(recorded);
  } else {
    poses_[added_ % capacity_] = recorded;
  }
  ++added_;
}

void PoseRecord::clear() {
  poses_.clear();
  added_ = 0;
}

std::vector<RecordedPose> PoseRecord::copy() const {
  const std::size_t oldest = forgotten() == 0 ? 0 : added_ % capacity_;
  std::vector<RecordedPose> out;
  out.reserve(poses_.size());
  const auto middle = poses_.begin() + static_cast<std::ptrdiff_t>(oldest);
  std::rotate_copy(poses_.begin(), middle, poses_.end(), std::back_inserter(out));
  return out;
}

std::string to_tum(const std::vector<RecordedPose>& poses, const std::string& comment) {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  std::string text = "# " + comment + "\n# t x y z qx qy qz qw\n";
  for (const RecordedPose& p : poses) {
    fmt::format_to(
        std::back_inserter(text), "{}.{:09} {:.6f} {:.6f} {:.6f} {:.8f} {:.8f} {:.8f} {:.8f}\n",
        p.stamp_ns / kSecondNs, p.stamp_ns % kSecondNs, p.position_m.x(), p.position_m.y(),
        p.position_m.z(), p.rotation.x(), p.rotation.y(), p.rotation.z(), p.rotation.w());
  }
  return text;
}

}  // namespace lilo
