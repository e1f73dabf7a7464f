// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/block_encoder.hpp"

#include <algorithm>
#include <numbers>

namespace lilo::sim {
namespace {

constexpr std::size_t kBlockBytes = 100, kPayload = 1206, kBank = 32;
constexpr double kRadians = std::numbers::pi / 180.0;
constexpr std::size_t kNoPause = 1000;

// Manuals, "vertical angles by laser id" and azimuth offsets.
constexpr std::array<double, 32> kVlp32c_deg{
    -25,    -1,     -1.667, -15.639, -11.31, 0,      -0.667, -8.843, -7.254, 0.333,  -0.333,
    -6.148, -5.333, 1.333,  0.667,   -4,     -4.667, 1.667,  1,      -3.667, -3.333, 3.333,
    2.333,  -2.667, -3,     7,       4.667,  -2.333, -2,     15,     10.333, -1.333};
constexpr std::array<double, 32> kVlp32cAzimuth_deg{
    1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
    1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4};
// Even lasers below, odd ones above, 1.33 degrees apart.
constexpr std::array<double, 32> kHdl32e_deg{
    -30.67, -9.33,  -29.33, -8,     -28,    -6.67, -26.67, -5.33,  -25.33, -4,     -24,
    -2.67,  -22.67, -1.33,  -21.33, 0,      -20,   1.33,   -18.67, 2.67,   -17.33, 4,
    -16,    5.33,   -14.67, 6.67,   -13.33, 8,     -12,    9.33,   -10.67, 10.67};
constexpr std::array<double, 1> kNoOffset_deg{0.0};
constexpr std::array<double, 128> kVls128_deg{
    -11.742, -1.99,   3.4,   -5.29,   -0.78, 4.61,  -4.08,   1.31,   -6.5,  -1.11,   4.28,  -4.41,
    0.1,     6.48,    -3.2,  2.19,    -3.86, 1.53,  -9.244,  -1.77,  2.74,  -5.95,   -0.56, 4.83,
    -2.98,   2.41,    -6.28, -0.89,   3.62,  -5.07, 0.32,    7.58,   -0.34, 5.18,    -3.64, 1.75,
    -25,     -2.43,   2.96,  -5.73,   0.54,  9.7,   -2.76,   2.63,   -7.65, -1.55,   3.84,  -4.85,
    3.18,    -5.51,   -0.12, 5.73,    -4.3,  1.09,  -16.042, -2.21,  4.06,  -4.63,   0.76,  15,
    -3.42,   1.97,    -6.85, -1.33,   -5.62, -0.23, 5.43,    -3.53,  0.98,  -19.582, -2.32, 3.07,
    -4.74,   0.65,    11.75, -2.65,   1.86,  -7.15, -1.44,   3.95,   -2.1,  3.29,    -5.4,  -0.01,
    4.5,     -4.19,   1.2,   -13.565, -1.22, 4.17,  -4.52,   0.87,   6.08,  -3.31,   2.08,  -6.65,
    1.42,    -10.346, -1.88, 3.51,    -6.06, -0.67, 4.72,    -3.97,  2.3,   -6.39,   -1,    4.39,
    -5.18,   0.21,    6.98,  -3.09,   4.98,  -3.75, 1.64,    -8.352, -2.54, 2.85,    -5.84, -0.45,
    8.43,    -2.87,   2.52,  -6.17,   -1.66, 3.73,  -4.96,   0.43};
constexpr std::array<double, 8> kVls128Azimuth_deg{6.354,  4.548,  2.732,  0.911,
                                                   -0.911, -2.732, -4.548, -6.354};

constexpr BlockSensor kVlp32c{
    Sensor::vlp32c,    0x28, 1, 0.004, 55'296, 2'304, 2, kNoPause, 0, 0.0424, kVlp32c_deg,
    kVlp32cAzimuth_deg};
// Manual, appendix E: the stamp is 542.592 us after the first firing of a single return packet.
constexpr BlockSensor kHdl32e{Sensor::hdl32e, 0x21,    1,   0.002,       46'080,       1'152, 1,
                              kNoPause,       -10'368, 0.0, kHdl32e_deg, kNoOffset_deg};
// The sequence as a real unit was found to take it; the manual says 53.3 us.
constexpr BlockSensor kVls128{Sensor::vls128, 0xA1,    4,           0.004,
                              55'278,         2'665,   8,           8,
                              8'700,          0.05863, kVls128_deg, kVls128Azimuth_deg};
constexpr std::array kSensors{&kVlp32c, &kHdl32e, &kVls128};

std::uint8_t mode_byte(ReturnMode mode) {
  return mode == ReturnMode::dual ? 0x39 : (mode == ReturnMode::last ? 0x38 : 0x37);
}

}  // namespace

const BlockSensor* find_block_sensor(Sensor sensor) {
  const auto* const found = std::find_if(kSensors.begin(), kSensors.end(),
                                         [&](const BlockSensor* s) { return s->sensor == sensor; });
  return found == kSensors.end() ? nullptr : *found;
}

std::vector<LaserCorrection> block_calibration(const BlockSensor& sensor) {
  std::vector<LaserCorrection> lasers(sensor.elevation_deg.size());
  for (std::size_t k = 0; k < lasers.size(); ++k) {
    lasers[k].elevation_rad = sensor.elevation_deg[k] * kRadians;
    lasers[k].rotation_rad = -sensor.azimuth_deg[k % sensor.azimuth_deg.size()] * kRadians;
    const SinCos e = sin_cos(lasers[k].elevation_rad);
    lasers[k].vertical_offset_m = -sensor.pivot_m * e.sin / e.cos;
  }
  return lasers;
}

BlockEncoder::BlockEncoder(const Rig& rig, const BlockSensor& sensor)
    : rig_(rig), sensor_(sensor), lasers_(block_calibration(sensor)) {}

void BlockEncoder::put(Packet& packet, std::size_t block, std::size_t channel,
                       const Echo& echo) const {
  const std::size_t at = block * kBlockBytes + 4 + 3 * channel;
  const std::uint32_t steps = distance_steps(echo.range_m, sensor_.distance_step_m);
  put_u16(packet.payload, at, steps);
  packet.payload[at + 2] = steps == 0 ? std::uint8_t{0} : echo.intensity;
}

Shot BlockEncoder::shoot(std::size_t laser, std::int64_t time_ns) {
  const double time_s = static_cast<double>(time_ns) * 1e-9;
  const LaserCorrection& c = lasers_[laser];
  const double azimuth_deg = rig_.rotor.azimuth_deg(time_s) - c.rotation_rad / kRadians;
  if (rig_.is_blind(azimuth_deg)) return {};
  const SinCos a = sin_cos(azimuth_deg * kRadians), e = sin_cos(c.elevation_rad);
  return rig_.fire({0.0, 0.0, c.vertical_offset_m}, {e.cos * a.cos, -e.cos * a.sin, e.sin}, time_s);
}

void BlockEncoder::fill_sequence(Packet& packet, std::size_t block, std::int64_t start_ns) {
  const std::size_t copies = is_dual() ? 2 : 1;
  const double azimuth = rig_.rotor.azimuth_deg(static_cast<double>(start_ns) * 1e-9);
  for (std::size_t k = 0; k < blocks_a_sequence(); ++k) {
    const std::size_t at = (block + k) * kBlockBytes;
    // FF EE, FF DD, FF CC, FF BB by bank.
    put_u16(packet.payload, at, 0xEEFF - 0x1100 * static_cast<std::uint32_t>(k / copies));
    put_u16(packet.payload, at + 2, Rotor::encoder(azimuth));
  }
  for (std::size_t laser = 0; laser < lasers_.size(); ++laser) {
    const Shot shot = shoot(laser, start_ns + sensor_.firing_ns(laser));
    const std::size_t at = block + laser / kBank * copies, channel = laser % kBank;
    if (!is_dual()) {
      put(packet, at, channel,
          rig_.options.returns == ReturnMode::last ? shot.last : shot.strongest);
      continue;
    }
    const bool same = shot.strongest.range_m == shot.last.range_m;
    put(packet, at, channel, shot.last);
    put(packet, at + 1, channel, same ? shot.second : shot.strongest);
  }
}

Packet BlockEncoder::encode(std::int64_t start_ns) {
  Packet packet{start_ns + period_ns(), kDataPort, std::vector<std::uint8_t>(kPayload, 0)};
  for (std::size_t k = 0; k < sequences(); ++k)
    fill_sequence(packet, k * blocks_a_sequence(),
                  start_ns + static_cast<std::int64_t>(k) * sensor_.sequence_ns);
  const std::int64_t counted_from_ns = start_ns + (sensor_.stamp_delay_ns < 0 ? period_ns() : 0);
  put_u32(packet.payload, 1200, rig_.clock.stamp_us(counted_from_ns + sensor_.stamp_delay_ns));
  packet.payload[1204] = mode_byte(rig_.options.returns);
  packet.payload[1205] = sensor_.product;
  return packet;
}

}  // namespace lilo::sim
