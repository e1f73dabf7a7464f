// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <numbers>
#include <string>

namespace lilo {

/// vlp16: VLP-16, Puck LITE and Puck Hi-Res; vls128: VLS-128, also sold as Alpha Prime.
enum class SensorModel : std::uint8_t { automatic, vlp16, hdl64e, vlp32c, hdl32e, vls128 };

/// Which returns of a dual-return sensor become part of the scan.
enum class ReturnChoice : std::uint8_t { strongest, last, both };

/// How packets become scans.
struct SensorConfig {
  SensorModel model = SensorModel::automatic;
  /// Packets are of `model`, whatever product their factory byte names.
  bool ignore_product_byte = false;
  /// db.xml or the ROS YAML form, of as many lasers as the sensor has. Empty: built in; HDL-64E:
  /// from the packets.
  std::string calibration_file;
  /// Where a table read from the packets in an earlier run was kept; empty: nowhere.
  std::string state_directory;
  double cut_azimuth_rad = 0.0;  ///< a scan starts here; clockwise from +x as the sensor counts
  double max_hole_rad = 5.0 * std::numbers::pi / 180.0;  ///< a larger hole makes a scan partial
  double min_range_m = 0.4;  ///< nearer returns are the robot itself or dust on the lens
  double max_range_m = 130.0;
  ReturnChoice returns = ReturnChoice::both;
  /// KITTI folders only: added to the elevation of every return. The data set's own calibration is
  /// said to be 0.205 deg low (Deschaud, IMLS-SLAM, ICRA 2018, section IV).
  double kitti_elevation_offset_rad = 0.0;
  /// Only what comes in here is a position packet, and nothing else of what does; 0: none is.
  /// Follows udp.position_port.
  std::uint16_t position_port = 8308;
};

}  // namespace lilo
