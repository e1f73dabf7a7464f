#pragma once

#include "drivers/azimuth.hpp"
#include "drivers/firing.hpp"
#include "drivers/hdl64e_calibration.hpp"
#include "drivers/packet_decoder.hpp"
#include "drivers/sensor_config.hpp"

#include <array>

namespace lilo {

/// When the lasers of an HDL-64E fire. Upper and lower block fire together, four lasers to a group.
/// S2 manual (48 us a shot) and S3 manual (57.6 us), "laser firing time table".
struct FiringTable {
  std::int32_t shot_ns;                  ///< from one shot of all lasers to the next
  std::int32_t group_ns;                 ///< from one group of four to the next
  std::array<std::int32_t, 4> laser_ns;  ///< within a group
};

/// The table that fits the time between packets, which differs by model and mode and is in no byte
/// of the packet: 288 us (6 shots of 48), 345.6 us (6 of 57.6), 172.8 us (3 of 57.6, dual return),
/// 144 us (3 of 48), each to 4 percent. Null when none fits.
const FiringTable* find_firing_table(double packet_period_ns, bool dual);

/// HDL-64E S2 and S3. Blocks alternate between lasers 0-31 (upper, flag EEFF) and 32-63 (lower,
/// DDFF); a pair is one shot and has one azimuth. In dual return mode two pairs are one shot.
///
/// With azimuth a of the head, rotational correction b, elevation w, d = distance + correction:
///   x = d_y cos w cos(a-b) + h sin(a-b),  y = -(d_x cos w sin(a-b) - h cos(a-b)),  z = d_m sin w +
///   v
/// (manual's axes turned to REP-103; offsets h, v are added last). d_x and d_y carry the near-range
/// corrections, linear between 2.40 m (x) or 1.93 m (y) and 25.04 m, where they meet the far one;
/// d_m is their mean, since the manual's choice of d_y alone bends z with the azimuth.
class Hdl64eDecoder final : public PacketDecoder {
 public:
  /// `azimuths` must outlive the decoder.
  Hdl64eDecoder(const SensorConfig& config, const AzimuthTable& azimuths);

  void use_calibration(const Hdl64eCalibration& calibration);
  /// The table append() works with; none before use_table().
  void use_table(const FiringTable* table);

  bool load(DataPacket packet) override;
  [[nodiscard]] std::span<const Column> columns() const override {
    return {columns_.data(), column_count_};
  }
  [[nodiscard]] double ticks_per_ns() const override { return ticks_per_ns_; }
  [[nodiscard]] double packet_period_ns() const override;
  [[nodiscard]] const BeamTable& beams() const override { return beams_; }
  [[nodiscard]] std::size_t max_column_returns() const override {
    return 2 * kBank * (dual_ && choice_ == ReturnChoice::both ? 2 : 1);
  }
  void append(std::size_t column, std::int32_t t_ns, Returns& out) const override;

  [[nodiscard]] bool is_dual() const { return dual_; }
  /// 0 while no table is in use.
  [[nodiscard]] std::int32_t shot_ns() const { return table_ == nullptr ? 0 : table_->shot_ns; }

 private:
  static constexpr std::size_t kBank = wire::kChannelsPerBlock;

  /// What returns need of their lasers' corrections: an array each, so that the compiler takes
  /// several lasers at a time.
  struct Lasers {
    using Floats = std::array<float, Hdl64eCalibration::kLasers>;
    using Ints = std::array<std::int32_t, Hdl64eCalibration::kLasers>;
    Floats cos_w, sin_w, cos_b, sin_b, b_rad;
    Floats dist_m, near_x, near_y, horizontal_m, vertical_m;
    Floats focal, slope, min_intensity, max_intensity;
    Ints min_steps, max_steps;
    Ints ring;
    float largest_b_rad;
  };
  using Bank = Firing<kBank>;  // one block's lasers

  [[nodiscard]] bool find_dual(const std::byte* packet) const;
  [[nodiscard]] Bank project(int block) const;
  void append_single(int pair, std::int32_t t_ns, Returns& out) const;
  void append_dual(int shot, std::int32_t t_ns, Returns& out) const;

  const AzimuthTable& azimuths_;
  double min_range_m_, max_range_m_;
  ReturnChoice choice_;
  float step_m_ = wire::kMetresPerStep;
  Lasers lasers_{};
  BeamTable beams_;
  const FiringTable* table_ = nullptr;
  std::array<std::int32_t, kBank> laser_ns_{};  // from the shot's first

  const std::byte* packet_ = nullptr;
  bool dual_ = false;
  double ticks_per_ns_ = 0.0;
  std::size_t column_count_ = 0;
  std::array<Column, wire::kBlocks / 2> columns_{};
};

}  // namespace lilo
