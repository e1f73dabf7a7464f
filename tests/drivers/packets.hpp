// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/calibration.hpp"
#include "drivers/scan_builder.hpp"
#include "drivers/sensor_table.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Packets made by the manuals' tables, for tests: an independent way from a known room to the
/// wire.
namespace lilo::test {

struct TimedPacket {
  std::vector<std::byte> bytes;
  std::int64_t received_ns = 0;
  std::uint32_t source_ipv4 = 0xC0A801C9;  // 192.168.1.201, as delivered
  std::uint16_t port = 2368;
  [[nodiscard]] PacketView view() const;
};

/// Writes fields where the manual puts them.
class PacketBytes {
 public:
  PacketBytes() : bytes_(1206) {}
  void block(int b, std::uint16_t flag, int azimuth_ticks);
  void channel(int b, int c, int steps, int intensity);
  void stamp(std::uint32_t us);
  void tail(std::uint8_t type, std::uint8_t value);
  [[nodiscard]] std::vector<std::byte> take() { return bytes_; }

 private:
  void u16(std::size_t at, int value);
  std::vector<std::byte> bytes_;
};

/// A room of 12 x 10 x 4 m, the sensor 1.5 m above its floor, and a pane of glass at x = 3 m.
struct Room {
  /// How far p is from the nearest wall, floor or ceiling; 0 on them.
  static double distance_to_surface_m(const Return& p);
  static double distance_to_glass_m(const Return& p);
  /// Outside of the room.
  static bool beyond(double x, double y, double z);
  static bool beyond_glass(double x, double y, double z) { return x > 3.0 || beyond(x, y, z); }
};

enum class Mode { strongest, last, dual };

struct DriveOptions {
  double rpm = 600.0;
  Mode mode = Mode::strongest;
  double start_azimuth_deg = 340.0;
  double start_past_hour_s = 1000.0;                           ///< sensor's clock
  std::int64_t start_received_ns = 1'715'678'200'000'000'000;  ///< 16 min 40 s past an hour
  bool counter_clockwise = false;
};

/// `count` VLP-16 packets of the room. In dual mode the strongest echo is the glass.
std::vector<TimedPacket> vlp16_packets(int count, const DriveOptions& options,
                                       std::uint8_t product = 0x22);

/// Packets of the room as a sensor with 32 lasers a block sends them: VLP-32C, HDL-32E or VLS-128.
/// Angles are those of the sensor's table, which real captures and `lilo sim` check; layout and
/// times are the manuals'. In dual mode the strongest echo is the glass.
struct RowOptions {
  SensorModel model = SensorModel::vlp32c;
  DriveOptions drive;
  double vls128_cycle_us = 55.278;  ///< as a real unit was found to have it
  std::uint8_t dual_byte = 0x39;    ///< 0x3B: with a third block a bank
};
std::vector<TimedPacket> row_packets(int count, const RowOptions& options);
double row_packet_us(const RowOptions& options);

struct HdlOptions {
  DriveOptions drive;
  Calibration calibration;
  bool s3 = false;  ///< 57.6 us a shot and a checksum, else 48 us and none
  bool break_checksum = false;
  bool gps = true;         ///< status byte G is 'A'
  int start_in_cycle = 0;  ///< packets of the status lap that came before the first one
  bool without_returns = false;
};
std::vector<TimedPacket> hdl64e_packets(int count, const HdlOptions& options);

/// Angles and offsets like those of a real unit, in whole hundredths of a degree and millimetres.
Calibration sample_calibration(bool two_point);

/// A position packet; `sentence` as it stands at 0xCE.
TimedPacket position_packet(std::uint32_t stamp_us, int pps, const std::string& sentence,
                            std::int64_t received_ns);
/// "$GPRMC,...*hh\r\n" of that instant.
std::string gprmc(int hour, int minute, int second, int day, int month, int year,
                  char status = 'A');

struct Outcome {
  std::vector<Scan> scans;
  DriverCounts counts;
  SensorStatus status;
};
/// All of them through a ScanBuilder.
Outcome build(const std::vector<TimedPacket>& packets, const SensorConfig& config = {});

}  // namespace lilo::test
