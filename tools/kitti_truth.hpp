// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/trajectory.hpp"

#include <string>

namespace lilo {

/// True poses of a folder of KITTI's, as poses of the sensor; times as open_scans() gives them to
/// the scans, so that scans and poses are matched by time. Both throw std::runtime_error, one line,
/// "file:line: ..." where a line is to blame.

/// A sequence: sequences/NN with velodyne/ and calib.txt. The poses are those of the left camera,
/// P_k = T_camera0_camera, in poses.txt beside them or in ../../poses/NN.txt; with Tr =
/// T_camera_sensor of calib.txt the sensor's are Tr^-1 P_k Tr.
Trajectory kitti_sequence_truth(const std::string& folder);

/// A raw drive: YYYY_MM_DD_drive_NNNN_sync with velodyne_points/data and oxts/data, and
/// calib_imu_to_velo.txt in its folder or the one above. The position of the GPS/IMU unit is taken
/// by the Mercator projection of the raw data's devkit: with s = cos(first latitude) and R =
/// 6378137 m, x = s R lon, y = s R log(tan(pi/4 + lat/2)), z = altitude; rotation Rz(yaw) Ry(pitch)
/// Rx(roll) (devkit: convertOxtsToPose.m, latlonToMercator.m). Times are those of
/// oxts/timestamps.txt, which differ from the scans' by some milliseconds.
Trajectory kitti_raw_truth(const std::string& folder);

/// T of a calibration file: the line `key: 12 numbers`, or in raw drives `R: 9` and `T: 3 numbers`.
Pose kitti_calibration(const std::string& file, const std::string& key);

}  // namespace lilo
