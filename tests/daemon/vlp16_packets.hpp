// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/packet_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace lilo {

/// A VLP-16 at 600 rpm in the middle of a room, as its manual says it sends (63-9243, section 9):
/// 12 blocks of two firing sequences, 55.296 us each, azimuth in hundredths of a degree. Ends after
/// `packets`. The room is a sphere of 10 m, in which no rotation can be seen, until it is told
/// otherwise.
class RoomSource : public PacketSource {
 public:
  explicit RoomSource(std::uint64_t packets) : packets_(packets) {}

  ReadResult read(PacketView& packet, std::chrono::milliseconds) override {
    if (sent_ == packets_) return ReadResult::end;
    write(sent_++);
    packet = {.received_ns = kStartNs + static_cast<std::int64_t>(stamp_ns(sent_)),
              .source_ipv4 = 0x7f000001,
              .source_port = 2368,
              .destination_port = 2368,
              .payload = bytes_};
    return ReadResult::packet;
  }
  [[nodiscard]] SourceCounts counts() const override { return {.packets = sent_}; }
  /// From now on another room.
  void be_in_a_room_of(double radius_m) { radius_m_ = radius_m; }
  /// From now on a room of four walls, the floor 1.5 m below the sensor, the ceiling 2.5 m above.
  void be_in_a_square_room() { is_square_ = true; }

  static constexpr double kPacketsPerTurn = 0.1e9 / (24 * 55296.0);

 private:
  static constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

  static double stamp_ns(std::uint64_t packet) {
    return static_cast<double>(packet) * 24 * 55296.0;
  }

  void put16(std::size_t at, unsigned value) {
    bytes_[at] = static_cast<std::byte>(value & 0xffU);
    bytes_[at + 1] = static_cast<std::byte>(value >> 8U & 0xffU);
  }

  /// In steps of 2 mm. The lasers fire 2.304 us apart. Those of even numbers look from -15 degrees
  /// up in steps of two, those of odd numbers from 1 degree.
  [[nodiscard]] unsigned distance_of(std::size_t channel, double block_ns) const {
    const std::size_t laser = channel % 16;
    const double fired_ns =
        block_ns + (channel < 16 ? 0.0 : 55296.0) + 2304.0 * static_cast<double>(laser);
    const double elevation_deg = static_cast<double>(laser) - (laser % 2 == 0 ? 15.0 : 0.0);
    const double azimuth_rad = std::fmod(fired_ns / 0.1e9, 1.0) * 2.0 * std::numbers::pi;
    const double elevation_rad = elevation_deg * std::numbers::pi / 180.0;
    return static_cast<unsigned>(std::lround(500.0 * range_m(azimuth_rad, elevation_rad)));
  }

  /// To the nearest wall, floor or ceiling.
  [[nodiscard]] double range_m(double azimuth_rad, double elevation_rad) const {
    if (!is_square_) return radius_m_;
    const double across =
        std::max(std::abs(std::cos(azimuth_rad)), std::abs(std::sin(azimuth_rad)));
    const double up = std::sin(elevation_rad);
    const double to_wall_m = radius_m_ / (across * std::cos(elevation_rad));
    return std::min(to_wall_m, up < 0.0 ? 1.5 / -up : 2.5 / up);
  }

  void write(std::uint64_t packet) {
    for (std::size_t block = 0; block < 12; ++block) {
      const double t_ns = stamp_ns(packet) + static_cast<double>(block) * 2 * 55296.0;
      const double azimuth = std::fmod(t_ns / 0.1e9, 1.0) * 36000.0;
      put16(block * 100, 0xeeff);
      put16(block * 100 + 2, static_cast<unsigned>(azimuth));
      for (std::size_t channel = 0; channel < 32; ++channel) {
        put16(block * 100 + 4 + channel * 3, distance_of(channel, t_ns));
        bytes_[block * 100 + 6 + channel * 3] = std::byte{50};
      }
    }
    // Of the hour that kStartNs lies in: 1.7e9 s is 800 s past one.
    const auto stamp_us = static_cast<std::uint32_t>(800e6 + stamp_ns(packet) * 1e-3);
    put16(1200, stamp_us & 0xffffU);
    put16(1202, stamp_us >> 16U);
    bytes_[1204] = std::byte{0x37};
    bytes_[1205] = std::byte{0x22};
  }

  std::uint64_t packets_;
  std::uint64_t sent_ = 0;
  double radius_m_ = 10.0;
  bool is_square_ = false;
  std::array<std::byte, 1206> bytes_{};
};

}  // namespace lilo
