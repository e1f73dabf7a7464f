// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lilo {

/// How one laser points and measures (HDL-64E S3 manual 63-HDL64ES3 rev. K, appendix "dual two
/// point calibration"; the other models need angles and heights alone). Metres and radians.
struct LaserCorrection {
  double rot_rad = 0.0;         ///< the laser points this much less than the head's azimuth
  double vert_rad = 0.0;        ///< elevation
  double dist_m = 0.0;          ///< added to the distance, found at 25.04 m
  double dist_x_m = 0.0;        ///< the same found near by, at x = 2.4 m
  double dist_y_m = 0.0;        ///< and at y = 1.93 m
  bool two_point = false;       ///< the two near ones hold
  double vert_offset_m = 0.0;   ///< height of the beam's origin
  double horiz_offset_m = 0.0;  ///< how far the beam's origin is to the left of the axis
  double focal_distance_m = 0.0;
  double focal_slope = 0.0;
  int min_intensity = 0, max_intensity = 255;

  bool operator==(const LaserCorrection&) const = default;
};

/// One unit's lasers, by the number they have on the wire: 16, 32, 64 or 128 of them.
struct Calibration {
  std::vector<LaserCorrection> lasers;
  /// Of the HDL-64E, whose early units had others. All other models' are the model's own.
  double distance_step_m = 0.002;

  bool operator==(const Calibration&) const = default;
};

/// Why this cannot be the table of a rotating Velodyne, one clause; empty when it can.
std::string implausible(const Calibration& calibration);

/// Reads Velodyne's db.xml (centimetres, degrees) or the YAML form of ros-drivers/velodyne (metres,
/// radians). Throws DriverError naming file, laser and key.
Calibration load_calibration(const std::string& path);

/// The YAML form, as load_calibration() reads it.
std::string calibration_yaml(const Calibration& calibration);

/// Where a table read from packets is kept in SensorConfig::state_directory. Who writes it does so
/// on another thread than the one that reads packets.
std::string stored_calibration_path(const std::string& state_directory);

/// Writes the YAML form, through a temporary file so that a reader never sees half of it. False
/// when the folder cannot be written.
bool store_calibration(const std::string& path, const Calibration& calibration);

}  // namespace lilo
