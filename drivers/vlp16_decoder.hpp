#pragma once

#include "drivers/azimuth.hpp"
#include "drivers/firing.hpp"
#include "drivers/packet_decoder.hpp"
#include "drivers/sensor_config.hpp"
#include "drivers/sensor_status.hpp"

#include <array>

namespace lilo {

/// VLP-16, Puck LITE (product 0x22) and Puck Hi-Res (0x24). Manual 63-9243 rev. D, chapter 9.
///
/// A firing sequence is 16 lasers 2.304 us apart and 18.432 us of recharge, 55.296 us in all; a
/// block holds two of them. The stamp is the first firing in the packet (9.4). The head turns
/// between lasers, so each laser's azimuth is the block's plus turning speed times its delay.
/// With azimuth a (clockwise), elevation w, distance r and the beam origin's height z0:
///   x = r cos w cos a,  y = -r cos w sin a,  z = r sin w + z0,  z0 = 41.91 mm tan(-w).
class Vlp16Decoder final : public PacketDecoder {
 public:
  /// `azimuths` must outlive the decoder.
  Vlp16Decoder(const SensorConfig& config, const AzimuthTable& azimuths);

  bool load(DataPacket packet) override;
  [[nodiscard]] std::span<const Column> columns() const override {
    return {columns_.data(), column_count_};
  }
  [[nodiscard]] double ticks_per_ns() const override { return ticks_per_ns_; }
  [[nodiscard]] double packet_period_ns() const override;
  [[nodiscard]] std::int64_t inner_gap_ns() const override { return gap_ns_; }
  [[nodiscard]] const BeamTable& beams() const override { return beams_; }
  [[nodiscard]] std::size_t max_column_returns() const override {
    const bool twice = mode_ == ReturnMode::dual && choice_ == ReturnChoice::both;
    return std::size_t{kLasers} * (twice ? 2 : 1);
  }
  void append(std::size_t column, std::int32_t t_ns, Returns& out) const override;

  [[nodiscard]] ReturnMode mode() const { return mode_; }
  [[nodiscard]] std::uint8_t product_id() const { return product_id_; }

  static constexpr int kLasers = 16;
  static constexpr std::uint8_t kProductVlp16 = 0x22;
  static constexpr std::uint8_t kProductHiRes = 0x24;

 private:
  struct Beams {
    std::array<float, kLasers> cos_elevation, sin_elevation, origin_z_m;
    std::array<std::int32_t, kLasers> ring;
  };
  using Sequence = Firing<kLasers>;
  struct Turn {  // how far the head has turned when a laser of the block fires
    std::array<float, wire::kChannelsPerBlock> cos, sin, rad;
    float largest_rad;
  };

  void set_product(std::uint8_t product_id);
  [[nodiscard]] ReturnMode find_mode(const std::byte* packet) const;
  void measure_turn(const std::byte* packet);
  void find_gap(const std::byte* packet);
  void place_columns(const std::byte* packet);
  [[nodiscard]] Sequence project(int block, int sequence) const;
  void append_single(int block, int sequence, std::int32_t t_ns, Returns& out) const;
  void append_dual(int shot, int sequence, std::int32_t t_ns, Returns& out) const;

  const AzimuthTable& azimuths_;
  Beams beam_{};
  BeamTable beams_;
  int min_steps_, max_steps_;  // range limits in distance steps
  ReturnChoice choice_;

  const std::byte* packet_ = nullptr;
  std::uint8_t product_id_ = 0;
  ReturnMode mode_ = ReturnMode::strongest;
  double ticks_per_ns_ = 0.0;       // within the packet
  double mean_ticks_per_ns_ = 0.0;  // of the last hundred packets or so
  Turn turn_{};
  int gap_block_ = 0;        // the first block after a blind sector; 0: none
  std::int32_t gap_ns_ = 0;  // how long that took
  std::size_t column_count_ = 0;
  std::array<Column, std::size_t{2} * wire::kBlocks> columns_{};
};

}  // namespace lilo
