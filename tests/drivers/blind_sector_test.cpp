// SPDX-License-Identifier: BSD-3-Clause
// A VLP-16 told to fire in a part of its turn sends nothing for the rest. How its firmware fills
// the packets at the ends of that part is in no manual: both ways that are possible are tested.
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace lilo {
namespace {

using test::build;
using test::Mode;
using test::Outcome;
using test::TimedPacket;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr int kTurns = 12;

struct Blind {
  int from_deg, to_deg;  // clockwise, as the sensor counts
  Mode mode = Mode::strongest;
  double rpm = 600.0;
  double cut_deg = 0.0;
  [[nodiscard]] bool holds(int ticks) const {
    return (ticks - from_deg * 100 + 36000) % 36000 < width_deg() * 100;
  }
  [[nodiscard]] int width_deg() const { return (to_deg - from_deg + 360) % 360; }
};

int azimuth_of(const TimedPacket& packet, std::size_t block) {
  return std::to_integer<int>(packet.bytes[100 * block + 2]) +
         256 * std::to_integer<int>(packet.bytes[100 * block + 3]);
}

std::vector<TimedPacket> whole_turns(const Blind& blind) {
  const double per_turn = 60.0 / blind.rpm / (55.296e-6 * (blind.mode == Mode::dual ? 12 : 24));
  return test::vlp16_packets(static_cast<int>(kTurns * per_turn) + 12,
                             {.rpm = blind.rpm, .mode = blind.mode, .start_azimuth_deg = 300.0});
}

// The packets that have not one firing outside of the sector are not sent.
std::vector<TimedPacket> without_packets(const Blind& blind) {
  auto packets = whole_turns(blind);
  std::erase_if(packets, [&](const TimedPacket& p) {
    return blind.holds(azimuth_of(p, 0)) && blind.holds(azimuth_of(p, 11));
  });
  return packets;
}

// Only blocks outside of the sector are sent, twelve to a packet, whose stamp is its first block's.
std::vector<TimedPacket> without_blocks(const Blind& blind) {
  const auto packets = whole_turns(blind);
  std::vector<TimedPacket> sent;
  TimedPacket next = packets[0];
  std::size_t filled = 0;
  const std::size_t stride = blind.mode == Mode::dual ? 2 : 1;
  for (std::size_t n = 0; n < packets.size(); ++n) {
    for (std::size_t b = 0; b < 12; b += stride) {
      if (blind.holds(azimuth_of(packets[n], b))) continue;
      const auto block = packets[n].bytes.begin() + static_cast<std::ptrdiff_t>(100 * b);
      std::copy_n(block, 100 * stride,
                  next.bytes.begin() + static_cast<std::ptrdiff_t>(100 * filled));
      if (filled == 0) {
        const double us = 1e9 + (static_cast<double>(n) * 12 + static_cast<double>(b)) * 110.592 /
                                    static_cast<double>(stride);
        for (std::size_t i = 0; i < 4; ++i)
          next.bytes[1200 + i] =
              static_cast<std::byte>(static_cast<std::uint32_t>(us) >> (8 * i) & 0xFFU);
      }
      filled += stride;
      next.received_ns = packets[n].received_ns;
      if (filled < 12) continue;
      sent.push_back(next);
      filled = 0;
    }
  }
  return sent;
}

Outcome build_cut(const std::vector<TimedPacket>& packets, const Blind& blind) {
  SensorConfig config;
  config.cut_azimuth_rad = blind.cut_deg * kDeg;
  return build(packets, config);
}

// Every return on the room's wall, and where the head was at its time. Where a packet leaps over
// the sector, the time of that is known by the speed alone, to 0.06 percent.
void expect_exact(const Outcome& out, const Blind& blind) {
  const double deg_per_ns = blind.rpm * 6e-9;
  for (const Scan& scan : out.scans) {
    ASSERT_FALSE(scan.returns.empty());
    const auto azimuth_deg = [](const Return& r) {
      return -static_cast<double>(r.azimuth_rad) / kDeg;
    };
    const double at_start_deg =
        azimuth_deg(scan.returns[0]) - static_cast<double>(scan.returns[0].t_ns) * deg_per_ns;
    for (const Return& r : scan.returns) {
      const bool on_wall = test::Room::distance_to_surface_m(r) < 0.002;
      ASSERT_TRUE(on_wall || test::Room::distance_to_glass_m(r) < 0.002);
      const double due_deg = at_start_deg + static_cast<double>(r.t_ns) * deg_per_ns;
      ASSERT_NEAR(std::remainder(azimuth_deg(r) - due_deg, 360.0), 0.0, 0.15);
    }
  }
}

void expect_known(const Outcome& out, const Blind& blind, double tolerance_deg) {
  EXPECT_NEAR(out.status.blind_width_rad / kDeg, blind.width_deg(), tolerance_deg);
  const double start_deg = -out.status.blind_start_rad / kDeg;
  EXPECT_NEAR(std::remainder(start_deg - blind.from_deg, 360.0), 0.0, tolerance_deg);
  ASSERT_GE(out.scans.size(), static_cast<std::size_t>(kTurns) - 2);
  for (std::size_t i = 6; i < out.scans.size(); ++i) {
    const Scan& scan = out.scans[i];
    EXPECT_TRUE(scan.complete) << i;
    EXPECT_EQ(scan.packets.lost, 0U) << i;
    EXPECT_LT(scan.hole_width_rad, 5.0 * kDeg);
    EXPECT_NEAR(static_cast<double>(scan.coverage_rad) / kDeg, 360 - blind.width_deg(),
                2.0 * tolerance_deg);
    EXPECT_EQ(scan.index, out.scans[i - 1].index + 1);
  }
}

const std::vector<Blind> kSectors = {{90, 270},
                                     {225, 135},  // the cut is blind
                                     {350, 20},
                                     {100, 160, Mode::dual},
                                     {60, 300, Mode::strongest, 1200},
                                     {60, 300, Mode::last, 300},
                                     {90, 270, Mode::strongest, 600, 180}};

TEST(BlindSector, PacketsNotSentAreNoLossOnceItIsKnown) {
  for (const Blind& blind : kSectors) {
    const Outcome out = build_cut(without_packets(blind), blind);
    SCOPED_TRACE(testing::Message() << blind.from_deg << " to " << blind.to_deg);
    EXPECT_EQ(out.counts.packets_lost, 0U);
    EXPECT_GT(out.counts.packets_blind, 0U);
    EXPECT_EQ(out.counts.sensor_restarts, 0U);
    EXPECT_EQ(out.counts.stalls, 0U);
    // Both ends waver by a packet.
    expect_known(out, blind, 360.0 * blind.rpm / 60.0 * 55.296e-6 * 24 + 0.5);
    expect_exact(out, blind);
  }
}

TEST(BlindSector, BlocksNotSentAreNoLossAndKeepTheirTime) {
  for (const Blind& blind : kSectors) {
    const Outcome out = build_cut(without_blocks(blind), blind);
    SCOPED_TRACE(testing::Message() << blind.from_deg << " to " << blind.to_deg);
    EXPECT_EQ(out.counts.packets_lost, 0U);
    EXPECT_EQ(out.counts.sensor_restarts, 0U);
    expect_known(out, blind, 2.0 * 6.0 * blind.rpm * 110.592e-6 + 0.3);
    expect_exact(out, blind);
  }
}

TEST(BlindSector, LossIsStillCountedExactly) {
  for (const Blind& blind : kSectors) {
    auto packets = without_blocks(blind);
    std::mt19937 random(5);
    std::size_t dropped = 0;
    // After it is known, and nothing after the last scan.
    for (std::size_t i = packets.size() * 9 / 10; i > packets.size() * 6 / 10; --i) {
      if (random() % 6 != 0) continue;
      packets.erase(packets.begin() + static_cast<std::ptrdiff_t>(i));
      ++dropped;
    }
    const Outcome out = build_cut(packets, blind);
    SCOPED_TRACE(testing::Message() << blind.from_deg << " to " << blind.to_deg);
    EXPECT_EQ(out.counts.packets_lost, dropped);
    expect_exact(out, blind);
  }
}

TEST(BlindSector, IsForgottenWhenTheSensorFiresThereAgain) {
  const Blind blind{90, 270};
  auto packets = without_packets(blind);
  const auto all = whole_turns(blind);
  packets.resize(packets.size() * 8 / 10);
  const std::int64_t end_ns = packets.back().received_ns;
  for (const TimedPacket& packet : all)
    if (packet.received_ns > end_ns) packets.push_back(packet);
  const Outcome out = build(packets);
  EXPECT_EQ(out.status.blind_width_rad, 0.0);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_NEAR(static_cast<double>(out.scans.back().coverage_rad) / kDeg, 360.0, 0.6);
  EXPECT_TRUE(out.scans.back().complete);
}

TEST(BlindSector, BurstsOfLossAreNone) {
  const Blind none{0, 0};
  auto packets = whole_turns(none);
  std::mt19937 random(9);
  std::size_t dropped = 0;
  for (std::size_t i = packets.size() - 60; i > 40;
       i -= std::min<std::size_t>(i, 50 + random() % 40)) {
    packets.erase(packets.begin() + static_cast<std::ptrdiff_t>(i - 20),
                  packets.begin() + static_cast<std::ptrdiff_t>(i));
    dropped += 20;
  }
  const Outcome out = build(packets);
  EXPECT_EQ(out.status.blind_width_rad, 0.0);
  EXPECT_EQ(out.counts.packets_lost, dropped);
}

}  // namespace
}  // namespace lilo
