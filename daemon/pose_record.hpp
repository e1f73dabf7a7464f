// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lilo {

struct RecordedPose {
  std::int64_t stamp_ns = 0;  ///< UTC
  Eigen::Vector3d position_m;
  Eigen::Quaternionf rotation;  ///< single precision: 1e-7 rad
};

/// The poses of a session, so far as there is room: beyond that the oldest are forgotten. Memory is
/// reserved at construction; add() allocates nothing.
class PoseRecord {
 public:
  explicit PoseRecord(std::size_t capacity) : capacity_(capacity) { poses_.reserve(capacity); }

  void add(std::int64_t stamp_ns, const Pose& pose);
  void clear();

  /// Oldest first.
  [[nodiscard]] std::vector<RecordedPose> copy() const;
  [[nodiscard]] std::uint64_t forgotten() const { return added_ - poses_.size(); }

 private:
  std::size_t capacity_;
  std::vector<RecordedPose> poses_;
  std::uint64_t added_ = 0;
};

/// As evo and the TUM tools read it: "t x y z qx qy qz qw" a line, seconds. `comment`: one line.
std::string to_tum(const std::vector<RecordedPose>& poses, const std::string& comment);

}  // namespace lilo
