// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/hdl64_encoder.hpp"

#include <numbers>
#include <utility>

namespace lilo::sim {
namespace {

constexpr std::size_t kBlockBytes = 100, kPayload = 1206;
constexpr double kRadians = std::numbers::pi / 180.0;

// "Laser firing time table" of the S2 and S3 manuals.
constexpr std::int64_t kPairS2_ns = 48'000, kPairS3_ns = 57'600;
constexpr std::int64_t kGroupS2_ns = 6'000, kGroupS3_ns = 7'200;
constexpr std::array<std::int64_t, 4> kShotS2_ns{0, 1'260, 2'460, 3'660};
constexpr std::array<std::int64_t, 4> kShotS3_ns{0, 1'300, 2'500, 3'700};

}  // namespace

Hdl64Encoder::Hdl64Encoder(const Rig& rig, std::vector<LaserCorrection> lasers,
                           std::int64_t start_utc_ns, std::uint64_t status_index)
    : rig_(rig),
      lasers_(std::move(lasers)),
      status_(rig.options, lasers_),
      start_utc_ns_(start_utc_ns),
      status_index_(status_index) {
  const bool s2 = rig.options.sensor == Sensor::hdl64_s2;
  pair_ns_ = s2 ? kPairS2_ns : kPairS3_ns;
  for (std::size_t k = 0; k < shot_ns_.size(); ++k) {
    shot_ns_[k] = static_cast<std::int64_t>(k / 4) * (s2 ? kGroupS2_ns : kGroupS3_ns) +
                  (s2 ? kShotS2_ns : kShotS3_ns)[k % 4];
  }
}

std::int64_t Hdl64Encoder::period_ns() const { return (is_dual() ? 3 : 6) * pair_ns_; }

Shot Hdl64Encoder::shoot(const LaserCorrection& laser, const Placement& pose, double azimuth_deg,
                         double time_s) {
  const double angle = azimuth_deg * kRadians - laser.rotation_rad;
  const SinCos a = sin_cos(angle), e = sin_cos(laser.elevation_rad);
  const Vec3 origin(laser.horizontal_offset_m * a.sin, laser.horizontal_offset_m * a.cos,
                    laser.vertical_offset_m);
  Vec3 direction(e.cos * a.cos, -e.cos * a.sin, e.sin);
  double offset = laser.distance_m;  // range along the ray minus raw range
  if (rig_.options.two_point) {
    // With the two-point correction the points of all raw ranges lie on a curve, not on the ray.
    // Find where the curve meets the scene; casting there makes the decoded point lie on it.
    for (int round = 0; round < 3; ++round) {
      const double range = rig_.laser.range_m(pose * origin, pose.rotation * direction, time_s);
      if (range <= 0.0) break;
      const Vec3 reach = hdl64_point(laser, range - offset, angle, true) - origin;
      offset += reach.norm() - range;
      direction = reach.normalized();
    }
  }
  Shot shot = rig_.laser.fire(pose * origin, pose.rotation * direction, time_s);
  for (Echo* echo : {&shot.strongest, &shot.second, &shot.last}) {
    echo->range_m = echo->range_m > offset ? echo->range_m - offset : 0.0;
  }
  return shot;
}

void Hdl64Encoder::put(Packet& packet, std::size_t block, std::size_t channel,
                       const Echo& echo) const {
  const std::size_t at = block * kBlockBytes + 4 + 3 * channel;
  const std::uint32_t steps = distance_steps(echo.range_m);
  put_u16(packet.payload, at, steps);
  packet.payload[at + 2] = steps == 0 ? std::uint8_t{0} : echo.intensity;
}

void Hdl64Encoder::fire_pair(Packet& packet, const Firing& firing) {
  const std::size_t copies = is_dual() ? 2 : 1;
  for (std::size_t k = 0; k < 2 * copies; ++k) {
    const std::size_t at = (firing.block + k) * kBlockBytes;
    put_u16(packet.payload, at, k % 2 == 0 ? 0xEEFF : 0xDDFF);
    put_u16(packet.payload, at + 2, Rotor::encoder(firing.azimuth_deg));
  }
  for (std::size_t channel = 0; channel < 32; ++channel) {
    const double time_s = static_cast<double>(firing.time_ns + shot_ns_[channel]) * 1e-9;
    const double azimuth =
        rig_.options.turning_block ? rig_.rotor.azimuth_deg(time_s) : firing.azimuth_deg;
    const Placement pose = rig_.path.at(time_s);
    for (std::size_t bank = 0; bank < 2; ++bank) {
      const LaserCorrection& laser = lasers_[32 * bank + channel];
      if (rig_.is_blind(azimuth - laser.rotation_rad / kRadians)) continue;
      const Shot shot = shoot(laser, pose, azimuth, time_s);
      const std::size_t block = firing.block + bank;
      if (!is_dual()) {
        put(packet, block, channel,
            rig_.options.returns == ReturnMode::last ? shot.last : shot.strongest);
        continue;
      }
      const bool same = shot.strongest.range_m == shot.last.range_m;
      put(packet, block, channel, shot.strongest);
      put(packet, block + 2, channel, same ? shot.second : shot.last);
    }
  }
}

Packet Hdl64Encoder::encode(std::int64_t start_ns) {
  Packet packet{start_ns + period_ns(), kDataPort, std::vector<std::uint8_t>(kPayload, 0)};
  const std::size_t blocks_per_firing = is_dual() ? 4 : 2;
  for (std::size_t block = 0; block < 12; block += blocks_per_firing) {
    const std::int64_t time_ns =
        start_ns + static_cast<std::int64_t>(block / blocks_per_firing) * pair_ns_;
    fire_pair(packet,
              {block, time_ns, rig_.rotor.azimuth_deg(static_cast<double>(time_ns) * 1e-9)});
  }
  put_u32(packet.payload, 1200, rig_.clock.stamp_us(start_ns + stamp_delay_ns()));
  const StatusBytes::Pair status =
      status_.at(status_index_++, (start_utc_ns_ + packet.sent_ns) / 1'000'000'000);
  packet.payload[1204] = status.type;
  packet.payload[1205] = status.value;
  return packet;
}

}  // namespace lilo::sim
