// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/motion.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lilo::sim {

enum class Sensor : std::uint8_t { vlp16, vlp16_hires, hdl64_s2, hdl64_s3, vlp32c, hdl32e, vls128 };
enum class ReturnMode : std::uint8_t { strongest, last, dual };

/// A part of the robot that moves with the sensor and is in its view: the corners of a box in the
/// sensor's axes, x and y and z from and to (m).
using RobotBox = std::array<double, 6>;

struct SensorOptions {
  Sensor sensor = Sensor::vlp16;
  ReturnMode returns = ReturnMode::strongest;
  double rpm = 600.0;
  double rpm_change_at_s = -1.0;  ///< negative: never
  double rpm_after = 600.0;       ///< reached 2 s after rpm_change_at_s; 0: the motor stops
  double range_sigma_m = 0.012;
  double dropout = 0.01;  ///< of a bright surface, near and seen frontally; 0: no drop-outs at all
  double max_range_m = 100.0;
  double min_range_m = 0.4;
  bool gps = true;  ///< position packets with GPRMC and PPS, sensor clock equal to UTC
  double clock_at_start_s = 0.0;  ///< without GPS: what the sensor's clock shows at the start
  double late_hour_wrap_s = 0.0;  ///< counts on beyond 3600 s for so long
  bool turning_block =
      false;               ///< HDL-64E: the head turns while a block fires (else one azimuth each)
  bool two_point = false;  ///< HDL-64E: near ranges need the two-point distance correction
  double blind_from_deg = 0.0,
         blind_to_deg = 0.0;  ///< clockwise sector without returns; empty: none
  std::vector<RobotBox> robot;
};

struct FaultOptions {
  double loss = 0.0;  ///< probability that a packet is lost
  double bursts_per_minute = 0.0;
  int burst_packets = 50;        ///< lost together in a burst
  double duplicates = 0.0;       ///< probability that a packet comes twice
  double reorder = 0.0;          ///< probability that a packet comes after the next one
  double garbage = 0.0;          ///< probability that something else comes before a packet
  double restart_at_s = -1.0;    ///< negative: never
  double restart_gap_s = 1.5;    ///< silence of a restarting sensor
  double host_step_at_s = -1.0;  ///< the capturing computer's clock jumps; negative: never
  double host_step_s = 0.0;
};

struct SimOptions {
  std::string world = "street";
  std::uint64_t seed = 1;
  MotionOptions motion;
  SensorOptions sensor;
  FaultOptions faults;
  std::optional<double> sensor_height_m;                  ///< instead of the world's vehicle's
  std::int64_t start_utc_ns = 1'715'678'100'123'457'000;  ///< 2024-05-14 09:15:00.123457
  bool nanosecond_pcap = false;
};

}  // namespace lilo::sim
