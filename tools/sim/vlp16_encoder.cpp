// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/vlp16_encoder.hpp"

#include <numbers>

namespace lilo::sim {
namespace {

constexpr std::size_t kBlocks = 12, kBlockBytes = 100, kPayload = 1206;

// Manual, "vertical angles by laser id".
constexpr std::array<double, 16> kElevation_deg{-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                -7,  9, -5,  11, -3,  13, -1, 15};
constexpr std::array<double, 16> kHiResElevation_deg{-10.00, 0.67, -8.67, 2.00, -7.33, 3.33,
                                                     -6.00,  4.67, -4.67, 6.00, -3.33, 7.33,
                                                     -2.00,  8.67, -0.67, 10.00};

std::uint8_t mode_byte(ReturnMode mode) {
  switch (mode) {
    case ReturnMode::strongest:
      return 0x37;
    case ReturnMode::last:
      return 0x38;
    case ReturnMode::dual:
      return 0x39;
  }
  return 0x37;
}

void put_return(Packet& packet, std::size_t block, std::size_t channel, const Echo& echo) {
  const std::size_t at = block * kBlockBytes + 4 + 3 * channel;
  const std::uint32_t steps = distance_steps(echo.range_m);
  put_u16(packet.payload, at, steps);
  packet.payload[at + 2] = steps == 0 ? std::uint8_t{0} : echo.intensity;
}

}  // namespace

std::vector<LaserCorrection> vlp16_calibration(Sensor sensor) {
  std::vector<LaserCorrection> lasers(16);
  for (std::size_t k = 0; k < lasers.size(); ++k) {
    const double degrees =
        sensor == Sensor::vlp16_hires ? kHiResElevation_deg[k] : kElevation_deg[k];
    const double elevation = degrees * std::numbers::pi / 180.0;
    const SinCos e = sin_cos(elevation);
    lasers[k].elevation_rad = elevation;
    lasers[k].vertical_offset_m = -Vlp16Encoder::kBeamPivot_m * e.sin / e.cos;
  }
  return lasers;
}

Vlp16Encoder::Vlp16Encoder(const Rig& rig) : rig_(rig) {
  const std::vector<LaserCorrection> lasers = vlp16_calibration(rig.options.sensor);
  for (std::size_t k = 0; k < beams_.size(); ++k) {
    beams_[k] = {sin_cos(lasers[k].elevation_rad), lasers[k].vertical_offset_m};
  }
}

std::int64_t Vlp16Encoder::period_ns() const {
  return (rig_.options.returns == ReturnMode::dual ? 12 : 24) * kSequence_ns;
}

void Vlp16Encoder::fill_block(Packet& packet, std::size_t block, std::int64_t start_ns) {
  const bool dual = rig_.options.returns == ReturnMode::dual;
  const double azimuth = rig_.rotor.azimuth_deg(static_cast<double>(start_ns) * 1e-9);
  for (std::size_t b = block; b < block + (dual ? 2 : 1); ++b) {
    put_u16(packet.payload, b * kBlockBytes, 0xEEFF);
    put_u16(packet.payload, b * kBlockBytes + 2, Rotor::encoder(azimuth));
  }
  for (std::size_t channel = 0; channel < 32; ++channel) {
    const Beam& beam = beams_[channel % 16];
    const std::int64_t time_ns = start_ns + static_cast<std::int64_t>(channel / 16) * kSequence_ns +
                                 static_cast<std::int64_t>(channel % 16) * kFiring_ns;
    const double time_s = static_cast<double>(time_ns) * 1e-9;
    const double now_deg = rig_.rotor.azimuth_deg(time_s);
    if (rig_.is_blind(now_deg)) continue;
    // Clockwise from the sensor's +Y; its +Y is our x, its +X our -y.
    const SinCos a = sin_cos(now_deg * std::numbers::pi / 180.0);
    const Shot shot = rig_.fire(
        {0.0, 0.0, beam.offset_z_m},
        {beam.elevation.cos * a.cos, -beam.elevation.cos * a.sin, beam.elevation.sin}, time_s);
    if (!dual) {
      put_return(packet, block, channel,
                 rig_.options.returns == ReturnMode::last ? shot.last : shot.strongest);
      continue;
    }
    // Manual, p. 57: even blocks hold the last return, odd ones the strongest, or the second
    // strongest where the strongest is the last.
    const bool same = shot.strongest.range_m == shot.last.range_m;
    put_return(packet, block, channel, shot.last);
    put_return(packet, block + 1, channel, same ? shot.second : shot.strongest);
  }
}

Packet Vlp16Encoder::encode(std::int64_t start_ns) {
  const bool dual = rig_.options.returns == ReturnMode::dual;
  Packet packet{start_ns + period_ns(), kDataPort, std::vector<std::uint8_t>(kPayload, 0)};
  const std::size_t step = dual ? 2 : 1;
  for (std::size_t block = 0; block < kBlocks; block += step) {
    fill_block(packet, block,
               start_ns + static_cast<std::int64_t>(block / step) * 2 * kSequence_ns);
  }
  put_u32(packet.payload, 1200, rig_.clock.stamp_us(start_ns));
  packet.payload[1204] = mode_byte(rig_.options.returns);
  packet.payload[1205] = rig_.options.sensor == Sensor::vlp16_hires ? 0x24 : 0x22;
  return packet;
}

}  // namespace lilo::sim
