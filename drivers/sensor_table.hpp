// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/calibration.hpp"
#include "drivers/sensor_config.hpp"
#include "drivers/wire.hpp"

#include <array>
#include <cstdint>
#include <span>

/// A model is data: what the packets of each rotating Velodyne say and how they say it.
/// PacketDecoder works with any of these tables; a new model is a new table in sensor_table.cpp.
namespace lilo {

/// When the lasers of one firing cycle fire.
struct FiringTimes {
  std::int32_t cycle_ns = 0;  ///< from one firing of a laser to its next
  /// By laser, after the first one of the cycle. HDL-64E: by number within the block; both blocks
  /// of a pair fire together.
  std::array<std::int32_t, kMaxRings> laser_ns{};
};

/// Where the second echo of a block stands in dual return mode.
enum class EchoOrder : std::uint8_t {
  /// In the block after it: first the last echo, then the strongest, or the second strongest where
  /// the last is the strongest (VLP-16 manual, 9.3.2 "Data Packet Structure").
  last_then_strongest,
  /// Behind all blocks of the cycle, first the strongest, then the last (HDL-64E; no manual page
  /// says which is which, the order is that of velodyne_decoder).
  strongest_then_last,
};

struct SensorTable {
  SensorModel model = SensorModel::automatic;
  const char* name = "";     ///< as Velodyne writes it
  std::uint8_t product = 0;  ///< payload byte 1205; 0: its packets name no product (HDL-64E)

  int lasers = 0;
  int banks = 1;             ///< blocks that hold the lasers of one firing cycle
  int cycles_per_block = 1;  ///< VLP-16: two cycles of 16 lasers a block
  std::array<std::uint16_t, 4> bank_flags{wire::kUpperFlag};
  bool banks_fire_together = false;  ///< else one after the other
  EchoOrder echoes = EchoOrder::last_then_strongest;
  bool has_confidence = false;  ///< a dual return mode with a third block, which has no returns

  double distance_step_m = 0.002;
  double max_range_m = 100.0;    ///< the data sheet's
  double range_noise_m = 0.012;  ///< one sigma, for the simulator
  double min_rpm = 300.0, max_rpm = 1200.0;

  /// Those that exist; more than one where the packets' period tells which (HDL-64E).
  std::span<const FiringTimes> times;
  /// The cycle is not kept: it is measured from the stamps, around the table's one.
  bool cycle_varies = false;
  /// The head's azimuth is that of each firing; else all lasers of a block have the block's.
  bool turns_within_block = true;
  /// The first firing of the packet after its stamp. Where the stamp is the packet's end, a
  /// packet's period is taken off.
  std::int32_t first_firing_ns = 0;
  bool stamp_is_packet_end = false;

  std::span<const double> elevation_deg;  ///< by laser; empty: each unit has a calibration
  std::span<const double> azimuth_deg;    ///< by laser, added to the head's; repeats; empty: zero
  double origin_radius_m = 0.0;           ///< beams meet the axis this far behind their origins

  [[nodiscard]] int cycles_per_packet(bool dual) const {
    return wire::kBlocks / (dual ? 2 * banks : banks) * cycles_per_block;
  }
  [[nodiscard]] double packet_period_ns(bool dual) const {
    return static_cast<double>(times.front().cycle_ns) * cycles_per_packet(dual);
  }
};

/// Every known one.
std::span<const SensorTable* const> sensor_tables();
/// The first of a model (VLP-16: the one that is not Hi-Res); automatic: null.
const SensorTable* find_sensor(SensorModel model);
/// By payload byte 1205; null: no product known here. Never an HDL-64E.
const SensorTable* find_product(std::uint8_t product);

/// The lasers of a table as a calibration, where all units have the same.
Calibration built_in_calibration(const SensorTable& table);

/// The times of `table` that fit the time between packets, to 4 percent: HDL-64E 288 us (6 cycles
/// of 48), 345.6 us (6 of 57.6), 172.8 us (3 of 57.6, dual return), 144 us (3 of 48). Null: none.
const FiringTimes* find_firing_times(const SensorTable& table, double packet_period_ns, bool dual);

}  // namespace lilo
