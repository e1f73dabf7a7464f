#pragma once

#include "core/scan.hpp"
#include "drivers/azimuth.hpp"
#include "drivers/firing.hpp"
#include "drivers/lasers.hpp"
#include "drivers/sensor_config.hpp"
#include "drivers/sensor_status.hpp"
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
///
/// With azimuth a (clockwise) of a laser, elevation w and distance r, and the height z0 of the
/// beam's origin:
///   x = r cos w cos a,  y = -r cos w sin a,  z = r sin w + z0,
/// where a is the head's azimuth at the firing less the laser's rotational correction. A
/// calibration with distance corrections or origins beside the axis (HDL-64E) adds, with h and v
/// the offsets:
///   x = d_y cos w cos a + h sin a,  y = -(d_x cos w sin a - h cos a),  z = d_m sin w + v.
/// d_x and d_y carry the near-range corrections, linear between 2.40 m (x) or 1.93 m (y) and
/// 25.04 m, where they meet the far one; d_m is their mean, since the manual's choice of d_y alone
/// bends z with the azimuth.
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
  [[nodiscard]] const BeamTable& beams() const { return lasers_.beams; }
  /// The most returns that one column can have in the mode of this packet.
  [[nodiscard]] std::size_t max_column_returns() const;
  /// Adds the returns of one column, in firing order; `t_ns` is the time of its first firing.
  void append(std::size_t column, std::int32_t t_ns, Returns& out) const;

  [[nodiscard]] const SensorTable& table() const { return *table_; }
  [[nodiscard]] ReturnMode mode() const { return layout_.mode; }
  [[nodiscard]] bool is_dual() const { return layout_.mode == ReturnMode::dual; }
  /// Null while not known.
  [[nodiscard]] const FiringTimes* times() const { return times_; }

 private:
  /// How the blocks of a packet are shared out, by the mode.
  struct Layout {
    ReturnMode mode = ReturnMode::strongest;
    int bank_stride = 1;      ///< from a bank's block to the next bank's
    int echo_stride = 0;      ///< from an echo's block to the second echo's
    int blocks_per_shot = 1;  ///< a shot: the blocks that share an azimuth
    int shots = wire::kBlocks;
  };
  struct Instant {
    std::uint32_t stamp_us = 0;
    int azimuth = 0;
  };
  static constexpr std::size_t kInstants = 8;

  [[nodiscard]] Layout find_layout(const std::byte* packet) const;
  [[nodiscard]] ReturnMode find_mode(const std::byte* packet) const;
  [[nodiscard]] ReturnMode find_mode_by_azimuths(const std::byte* packet) const;
  [[nodiscard]] bool is_whole(const std::byte* packet, const Layout& layout) const;
  [[nodiscard]] int shot_azimuth(int shot) const;
  void follow_cycle(std::uint32_t stamp_us);
  void measure_speed();
  [[nodiscard]] double speed_within_packet() const;
  [[nodiscard]] double speed_over_packets();
  void turn_lasers();
  void find_gap();
  void place_columns();

  template <std::size_t kLasers, bool kCorrected>
  [[nodiscard]] Firing<kLasers> project(int block, std::size_t laser, std::size_t angle) const;
  [[nodiscard]] Firing<16> project16(int block, std::size_t laser, std::size_t angle) const;
  [[nodiscard]] Firing<32> project32(int block, std::size_t laser, std::size_t angle) const;
  [[nodiscard]] Firing<16> correct16(int block, std::size_t laser, std::size_t angle) const;
  [[nodiscard]] Firing<32> correct32(int block, std::size_t laser, std::size_t angle) const;
  template <auto kProject>
  void append_with(int block, std::size_t angle, std::int32_t t_ns, Returns& out) const;
  template <auto kProject>
  void append_single(int block, std::size_t angle, std::int32_t t_ns, Returns& out) const;
  template <auto kProject>
  void append_together(int block, std::int32_t t_ns, Returns& out) const;
  template <auto kProject>
  void append_dual(int block, std::size_t angle, std::int32_t t_ns, Returns& out) const;
  template <auto kProject>
  void append_dual_together(int block, std::int32_t t_ns, Returns& out) const;

  const AzimuthTable& azimuths_;
  double min_range_m_, max_range_m_;
  ReturnChoice choice_;

  const SensorTable* table_ = nullptr;
  const FiringTimes* times_ = nullptr;
  double cycle_ns_ = 0.0;  // the times' own, or measured where it varies
  int cycles_seen_ = 0;
  std::array<std::int32_t, kMaxRings> delay_ns_{};  // by angle, after the block's first firing
  std::int32_t last_delay_ns_ = 0;                  // of the last laser of a cycle
  std::size_t angle_count_ = 0;
  Lasers lasers_{};

  const std::byte* packet_ = nullptr;
  Layout layout_;
  std::uint32_t last_stamp_us_ = 0;
  double ticks_per_ns_ = 0.0;
  double mean_ticks_per_ns_ = 0.0;  // of the last hundred packets or so
  LaserAngles angles_{};
  int gap_shot_ = 0;         // the first shot after a blind sector; 0: none
  std::int32_t gap_ns_ = 0;  // how long that took
  std::size_t column_count_ = 0;
  std::array<Column, std::size_t{2} * wire::kBlocks> columns_{};
  std::array<Instant, kInstants> instants_{};  // of the last packets
  std::size_t instant_count_ = 0;
};

}  // namespace lilo
