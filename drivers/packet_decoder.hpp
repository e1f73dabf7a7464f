// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/azimuth.hpp"
#include "drivers/packet_returns.hpp"
#include "drivers/sensor_config.hpp"
#include "drivers/sensor_table.hpp"
#include "drivers/wire.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lilo {

using DataPacket = std::span<const std::byte, wire::kDataPacketBytes>;

/// The smallest piece of a packet a scan can be cut at: one firing cycle of the lasers.
struct Column {
  double azimuth_ticks = 0.0;  ///< of its first firing, clockwise, in [0, 36000)
  std::int32_t first_ns = 0;   ///< its first firing after the packet's stamp
  std::int32_t last_ns = 0;    ///< its last firing after the packet's stamp
};

/// The packets of whatever SensorTable is in use: where the columns are, then the returns of each.
class PacketDecoder {
 public:
  /// `azimuths` must outlive the decoder.
  PacketDecoder(const SensorConfig& config, const AzimuthTable& azimuths);
  PacketDecoder(const PacketDecoder&) = delete;
  PacketDecoder& operator=(const PacketDecoder&) = delete;

  /// Packets are this sensor's from now on. Lasers and times are the table's own where it has one
  /// of each; else they must be given before append().
  void use(const SensorTable& table);
  /// As many lasers as the table has.
  void use_calibration(const Calibration& calibration);
  /// Null: not known. There are no columns then.
  void use_times(const FiringTimes* times);

  /// Reads azimuths and mode. False: not a packet of this sensor, nothing may be asked of it.
  /// The packet's bytes must outlive the calls below.
  bool load(DataPacket packet);
  /// In firing order.
  [[nodiscard]] std::span<const Column> columns() const { return {columns_.data(), column_count_}; }
  /// Turning speed, negative when the azimuth decreases.
  [[nodiscard]] double ticks_per_ns() const { return ticks_per_ns_; }
  /// Time from one packet's stamp to the next one's; 0 while it is not known.
  [[nodiscard]] double packet_period_ns() const;
  /// Time within the packet in which nothing fired (a blind sector): the next stamp is as much
  /// later.
  [[nodiscard]] std::int64_t inner_gap_ns() const { return gap_ns_; }
  [[nodiscard]] const BeamTable& beams() const { return packet_.lasers.beams; }
  /// The most returns that one column can have in the mode of this packet.
  [[nodiscard]] std::size_t max_column_returns() const;
  /// Adds the returns of one column, in firing order; `t_ns` is the time of its first firing.
  void append(std::size_t column, std::int32_t t_ns, Returns& out) const {
    append_column(packet_, column, t_ns, out);
  }

  [[nodiscard]] const SensorTable& table() const { return *packet_.table; }
  [[nodiscard]] ReturnMode mode() const { return packet_.layout.mode; }
  [[nodiscard]] bool is_dual() const { return packet_.layout.is_dual(); }
  /// Null while not known.
  [[nodiscard]] const FiringTimes* times() const { return packet_.times; }

 private:
  struct Instant {
    std::uint32_t stamp_us = 0;
    int azimuth = 0;
  };
  static constexpr std::size_t kInstants = 8;

  [[nodiscard]] int azimuth_of(int shot) const {
    return shot_azimuth(packet_.bytes, packet_.layout, shot);
  }
  void follow_cycle(std::uint32_t stamp_us);
  void measure_speed();
  [[nodiscard]] double speed_within_packet() const;
  [[nodiscard]] double speed_over_packets();
  void turn_to_speed();
  void find_gap();
  void place_columns();

  double min_range_m_, max_range_m_;
  PacketContents packet_;

  double cycle_ns_ = 0.0;  // the times' own, or measured where it varies
  int cycles_seen_ = 0;
  std::array<std::int32_t, kMaxRings> delay_ns_{};  // by angle, after the block's first firing
  std::int32_t last_delay_ns_ = 0;                  // of the last laser of a cycle
  std::size_t angle_count_ = 0;

  std::uint32_t last_stamp_us_ = 0;
  double ticks_per_ns_ = 0.0;
  double mean_ticks_per_ns_ = 0.0;  // of the last hundred packets or so
  int gap_shot_ = 0;                // the first shot after a blind sector; 0: none
  std::int32_t gap_ns_ = 0;         // how long that took
  std::size_t column_count_ = 0;
  std::array<Column, std::size_t{2} * wire::kBlocks> columns_{};
  std::array<Instant, kInstants> instants_{};  // of the last packets
  std::size_t instant_count_ = 0;
};

}  // namespace lilo
