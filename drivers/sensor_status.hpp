// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/sensor_config.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lilo {

enum class ReturnMode : std::uint8_t { strongest, last, dual };

/// Where the geometry of the lasers comes from.
enum class CalibrationOrigin : std::uint8_t {
  none,      ///< HDL-64E without a table: its packets cannot be used yet
  built_in,  ///< the same for every unit of the model (all but HDL-64E)
  file,      ///< SensorConfig::calibration_file
  stored,    ///< kept from an earlier run in SensorConfig::state_directory
  packets,   ///< read from the status bytes of this run
};

/// The last packets that were refused because they are of another sensor than the one configured or
/// followed.
struct RefusedSensor {
  std::uint64_t packets = 0;                   ///< as DriverCounts::wrong_sensor_packets
  SensorModel model = SensorModel::automatic;  ///< automatic: of none that is known here
  std::uint8_t product_id = 0;                 ///< 0: HDL-64E

  /// "VLP-32C", "unknown sensor"; empty while none was refused.
  [[nodiscard]] std::string_view model_name() const;
  /// "VLP-32C (product byte 0x28)"; empty while none was refused.
  [[nodiscard]] std::string name() const;
};

/// What is known of the sensor. Zero where nothing is.
struct SensorStatus {
  SensorModel model = SensorModel::automatic;       ///< automatic: no packet of a known model yet
  SensorModel configured = SensorModel::automatic;  ///< SensorConfig::model
  std::uint8_t product_id = 0;                      ///< as in SensorTable: VLP-16 0x22; HDL-64E: 0
  ReturnMode return_mode = ReturnMode::strongest;
  double rpm = 0.0;
  double packet_period_us = 0.0;  ///< HDL-64E: 0 until it is measured
  /// Sector in which the sensor sends nothing turn after turn (field of view set in its web page),
  /// from this azimuth (as Return::azimuth_rad) in the direction of turning; width 0: none.
  double blind_start_rad = 0.0, blind_width_rad = 0.0;
  ClockSource clock = ClockSource::host;
  CalibrationOrigin calibration = CalibrationOrigin::none;
  double calibration_progress = 0.0;       ///< part of the table read from packets, in [0, 1]
  std::uint64_t calibrations_refused = 0;  ///< tables whose checksum or values were wrong
  std::uint8_t firmware = 0;               ///< HDL-64E: 0x47 is 4.07
  std::uint8_t temperature_c = 0;          ///< HDL-64E
  std::uint32_t sensor_ipv4 = 0;           ///< of the data packets in use; host byte order
  RefusedSensor refused;
};

}  // namespace lilo
