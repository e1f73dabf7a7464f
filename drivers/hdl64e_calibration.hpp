#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace lilo {

/// How one laser of an HDL-64E points and measures (S3 manual 63-HDL64ES3 rev. K, appendix "dual
/// two point calibration"). Metres and radians.
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

struct Hdl64eCalibration {
  static constexpr std::size_t kLasers = 64;
  std::array<LaserCorrection, kLasers> lasers{};
  double distance_step_m = 0.002;

  bool operator==(const Hdl64eCalibration&) const = default;
};

/// Why this cannot be the table of an HDL-64E, one clause; empty when it can.
std::string implausible(const Hdl64eCalibration& calibration);

/// Reads Velodyne's db.xml (centimetres, degrees) or the YAML form of ros-drivers/velodyne (metres,
/// radians). Throws DriverError naming file, laser and key.
Hdl64eCalibration load_calibration(const std::string& path);

/// The YAML form, as load_calibration() reads it.
std::string calibration_yaml(const Hdl64eCalibration& calibration);

/// Where a table read from packets is kept in SensorConfig::state_directory. Who writes it does so
/// on another thread than the one that reads packets.
std::string stored_calibration_path(const std::string& state_directory);

/// Writes the YAML form, through a temporary file so that a reader never sees half of it. False
/// when the folder cannot be written.
bool store_calibration(const std::string& path, const Hdl64eCalibration& calibration);

}  // namespace lilo
