// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/calibration.hpp"
#include "drivers/packet_source.hpp"
#include "drivers/sensor_config.hpp"
#include "drivers/sensor_status.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace lilo {

/// Takes finished scans. exchange() is called once a revolution, in the middle of a packet if the
/// cut lies there, and returns the (cleared) scan to write next: a ring slot in the daemon, the
/// same object again in tools. No copy of returns is ever made. Until then returns are only added
/// at the end of the scan being written, but for a packet that was overtaken.
class ScanSink {
 public:
  ScanSink() = default;
  ScanSink(const ScanSink&) = delete;
  ScanSink& operator=(const ScanSink&) = delete;
  virtual ~ScanSink() = default;
  virtual Scan& exchange(Scan& finished) = 0;
  /// The returns of an overtaken packet were inserted at `index` into the scan being written.
  virtual void inserted(std::size_t /*index*/) {}
};

/// Totals since the start. Every byte that came in is in one of these.
struct DriverCounts {
  std::uint64_t data_packets = 0;
  std::uint64_t position_packets = 0;
  std::uint64_t malformed_packets = 0;  ///< wrong size, port, flag or azimuth: counted, never fatal
  std::uint64_t packets_lost = 0;
  std::uint64_t packets_duplicated = 0;
  std::uint64_t packets_reordered = 0;
  /// Of those reordered: what they bring is missing in a scan that had been handed on, which counts
  /// them as lost for ever. So the lost packets of all scans, and those lost outside of scans, are
  /// packets_lost + packets_late + packets_blind together.
  std::uint64_t packets_late = 0;
  /// Never sent, but counted as lost in scans handed on before the blind sector was known.
  std::uint64_t packets_blind = 0;
  std::uint64_t scans_complete = 0;
  std::uint64_t scans_partial = 0;
  std::uint64_t sensor_restarts = 0;  ///< its clock jumped
  std::uint64_t stalls = 0;           ///< its head did not come round within half a second
  std::uint64_t foreign_packets = 0;  ///< from another address than the sensor being followed
  /// Of another model than the configured or followed one (SensorStatus::refused names it).
  std::uint64_t wrong_sensor_packets = 0;
  std::uint64_t waiting_packets = 0;  ///< came before the firing times or the table were known
};

struct Calibration;

/// That of SensorConfig::calibration_file, if it names one. Throws DriverError when it cannot be
/// read or is of another number of lasers than the configured sensor.
std::optional<Calibration> configured_calibration(const SensorConfig& config);

/// Packets to scans: finds the model, decodes, cuts by azimuth, keeps the sensor's clock.
/// One thread; nothing a packet holds can harm it. A scan that is written gets memory for all that
/// a revolution can hold when it begins: with a sink of two scans there is no allocation after the
/// first revolution, until the sensor's mode or speed asks for more.
class ScanBuilder {
 public:
  /// `target` is written first. Throws DriverError when the calibration cannot be read.
  ScanBuilder(const SensorConfig& config, Scan& target, ScanSink& sink);
  ~ScanBuilder();
  ScanBuilder(const ScanBuilder&) = delete;
  ScanBuilder& operator=(const ScanBuilder&) = delete;

  void feed(const PacketView& packet);

  /// Between packets: what the sensor is and does, as far as it is known.
  [[nodiscard]] SensorStatus status() const;
  [[nodiscard]] const DriverCounts& counts() const;

  /// HDL-64E: the table in use, or null while there is none.
  [[nodiscard]] const Calibration* calibration() const;
  /// HDL-64E: use this table, which was read from the packets by someone else.
  void use_calibration(const Calibration& calibration);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lilo
