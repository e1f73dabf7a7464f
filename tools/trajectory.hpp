// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lilo {

struct StampedPose {
  std::int64_t stamp_ns = 0;  ///< UTC; the row number where the file knows no times
  Pose pose;                  ///< T_odom_sensor
};

/// Poses in the order of the file.
struct Trajectory {
  std::string name;        ///< the file, for messages
  bool has_times = false;  ///< TUM: yes, KITTI: no
  std::vector<StampedPose> poses;
};

/// Reads TUM (`t x y z qx qy qz qw`, t in UTC seconds, strictly growing) or KITTI (12 numbers, the
/// upper 3 x 4 part of the matrix row by row); the number of columns tells which. Empty lines and
/// lines that start with `#` are left out. Throws std::runtime_error, one line, "file:line: ...".
Trajectory read_trajectory(const std::string& path);

/// TUM: nine decimals of a second, nine of a metre. Throws std::runtime_error.
void write_tum(const std::string& path, const std::vector<StampedPose>& poses);
/// One line of it, without the line's end.
std::string tum_line(const StampedPose& stamped);

/// KITTI: the same poses without their times, in the sensor's frame. Throws std::runtime_error.
void write_kitti(const std::string& path, const std::vector<StampedPose>& poses);

/// Distance travelled up to every pose, in metres; the first is 0.
std::vector<double> travelled_m(const std::vector<Pose>& poses);

}  // namespace lilo
