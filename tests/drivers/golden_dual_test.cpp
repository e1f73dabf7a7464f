// SPDX-License-Identifier: BSD-3-Clause
// A real VLP-16 in dual return mode against the cloud an independent decoder made of its packets.
#include "drivers/wire.hpp"
#include "tests/drivers/bag.hpp"
#include "tests/drivers/data_dir.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>

namespace lilo {
namespace {

const char* const kBag = "real/vlp16_dual.db3";
const char* const kCloud = "real/vlp16_dual_expected.pcd";

#pragma pack(push, 1)
struct Expected {
  float x, y, z;
  std::uint8_t intensity, return_type;
  std::uint16_t channel;
  float azimuth, elevation, distance;
  std::uint32_t time_stamp;
};
#pragma pack(pop)
static_assert(sizeof(Expected) == 32);

std::vector<Expected> read_cloud() {
  std::ifstream in(test::data_path(kCloud), std::ios::binary);
  const std::string data(std::istreambuf_iterator<char>(in), {});
  const std::string marker = "DATA binary\n";
  const std::size_t begin = data.find(marker) + marker.size();
  std::vector<Expected> points((data.size() - begin) / sizeof(Expected));
  std::memcpy(points.data(), data.data() + begin, points.size() * sizeof(Expected));
  return points;
}

TEST(RealVlp16Dual, BagHoldsItsPackets) {
  LILO_NEED_DATA(kBag);
  const auto packets = test::packets_of_bag(test::data_path(kBag));
  ASSERT_EQ(packets.size(), 603U);
  const test::Outcome out = test::build(packets);
  EXPECT_EQ(out.counts.malformed_packets, 0U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_EQ(out.status.return_mode, ReturnMode::dual);
  EXPECT_EQ(out.status.packet_period_us, 663.552);
}

// A return as the reference states it: it knows no height of the beam's origin.
struct Polar {
  double azimuth_deg, range_m;
  int intensity;
  ReturnKind kind;
};

Polar polar_of(const Return& r, const BeamTable& beams) {
  const double w = static_cast<double>(beams.elevation_rad[r.ring]);
  const double z = static_cast<double>(r.z_m) - 0.04191 * std::tan(-w);
  return {.azimuth_deg = -static_cast<double>(r.azimuth_rad) * 180.0 / std::numbers::pi,
          .range_m = std::hypot(static_cast<double>(r.x_m), static_cast<double>(r.y_m), z),
          .intensity = r.intensity,
          .kind = r.kind};
}

// What the reference makes of the wire. Its azimuths are not ours, by the block and laser that its
// time stamps name (they count 110.592 us a block from the packet's start, also for the two blocks
// of one shot):
// - it turns the head by the step to the next shot, which has the noise of the encoder (ours: by
// the
//   packet's mean step), and rounds to a tick;
// - in the last shot it does not turn the head between lasers;
// - the second echo of a pair that differs gets the azimuth of the shot after, not turned either.
struct WireReturn {
  double reference_deg,
      mean_step_deg;  // azimuth by the reference's rules, and by the packet's mean
  int steps, intensity;
};

int azimuth_at(const test::TimedPacket& packet, std::size_t block) {
  return wire::u16(packet.bytes.data() + 100 * block + 2);
}

constexpr std::size_t kPlaces = std::size_t{12} * 32;

void add_packet(const test::TimedPacket& packet,
                std::array<std::vector<WireReturn>, kPlaces>& all) {
  const auto turned = [&](std::size_t from, std::size_t to) {
    return std::remainder(azimuth_at(packet, to) - azimuth_at(packet, from), 36000.0);
  };
  const double mean = turned(0, 10) / 5.0;
  for (std::size_t b = 0; b < 12; ++b)
    for (std::size_t c = 0; c < 32; ++c) {
      const std::size_t sequence = c / 16, laser = c % 16;
      const double part =
          (55.296 * static_cast<double>(sequence) + 2.304 * static_cast<double>(laser)) / 110.592;
      const double own = azimuth_at(packet, b);
      const double reference = b >= 10      ? own
                               : b % 2 == 1 ? azimuth_at(packet, b + 1)
                                            : own + turned(b, b + 2) * part;
      const std::byte* bytes = packet.bytes.data() + 100 * b + 4 + 3 * c;
      all[b * 32 + c].push_back({.reference_deg = reference * 0.01,
                                 .mean_step_deg = (own + mean * part) * 0.01,
                                 .steps = wire::u16(bytes),
                                 .intensity = wire::u8(bytes + 2)});
    }
}

// Block and channel of a point, by its time stamp.
std::size_t place_of(const Expected& e) {
  const double t_us = e.time_stamp * 1e-3 + 0.5;
  const auto block = static_cast<std::size_t>(t_us / 110.592);
  const double delay_us = t_us - static_cast<double>(block) * 110.592;
  const auto sequence = static_cast<std::size_t>(delay_us / 55.296);
  const auto laser =
      static_cast<std::size_t>((delay_us - static_cast<double>(sequence) * 55.296) / 2.304);
  return block * 32 + sequence * 16 + laser;
}

const WireReturn* find_on_wire(const Expected& e, const std::vector<WireReturn>& candidates) {
  const double azimuth_deg = static_cast<double>(e.azimuth) * 180.0 / std::numbers::pi;
  const WireReturn* best = nullptr;
  double least = 0.0101;
  for (const WireReturn& w : candidates) {
    const double apart = std::abs(std::remainder(w.reference_deg - azimuth_deg, 360.0));
    const bool same = w.intensity == e.intensity &&
                      std::abs(w.steps * 0.002 - static_cast<double>(e.distance)) < 1e-3;
    if (!same || apart >= least) continue;
    least = apart;
    best = &w;
  }
  return best;
}

// The return of ours that is nearest to that azimuth and range.
struct Match {
  double azimuth_deg = 180.0, range_m = 100.0;  // ours less what was asked for
};

Match best_match(double azimuth_deg, const Expected& e, const std::vector<Polar>& candidates) {
  Match best;
  double least = 1e9;
  for (const Polar& p : candidates) {
    const Match m{std::remainder(p.azimuth_deg - azimuth_deg, 360.0),
                  p.range_m - static_cast<double>(e.distance)};
    const double cost = 100.0 * std::abs(m.azimuth_deg) + std::abs(m.range_m);
    if (cost >= least || p.intensity != e.intensity) continue;
    least = cost;
    best = m;
  }
  return best;
}

// Each point is one of the wire by the reference's rules, to the rounding of a tick, and ours is
// that one by the packet's mean step. `within` are those that need no word on steps at all.
TEST(RealVlp16Dual, EveryPointOfTheReferenceIsFoundOrExplained) {
  LILO_NEED_DATA(kBag);
  LILO_NEED_DATA(kCloud);
  const auto cloud = read_cloud();
  ASSERT_EQ(cloud.size(), 14831U);
  const auto packets = test::packets_of_bag(test::data_path(kBag));
  std::array<std::vector<WireReturn>, kPlaces> wire_returns;
  for (const test::TimedPacket& packet : packets) add_packet(packet, wire_returns);
  const test::Outcome out = test::build(packets);
  ASSERT_EQ(out.scans.size(), 3U);
  const Scan& scan = out.scans.back();
  std::array<std::vector<Polar>, 16> rings;
  for (const Return& r : scan.returns) rings[r.ring].push_back(polar_of(r, scan.beams));
  int within = 0, explained = 0, unexplained = 0;
  double worst_range_m = 0.0, worst_azimuth_deg = 0.0;
  for (const Expected& e : cloud) {
    ASSERT_LT(e.channel, 16);
    const std::size_t place = place_of(e);
    ASSERT_LT(place, wire_returns.size());
    const WireReturn* on_wire = find_on_wire(e, wire_returns[place]);
    if (on_wire == nullptr) {
      ++unexplained;
      continue;
    }
    const Match m = best_match(on_wire->mean_step_deg, e, rings[e.channel]);
    worst_range_m = std::max(worst_range_m, std::abs(m.range_m));
    worst_azimuth_deg = std::max(worst_azimuth_deg, std::abs(m.azimuth_deg));
    const double rules_deg = std::remainder(on_wire->mean_step_deg - on_wire->reference_deg, 360.0);
    if (std::abs(m.azimuth_deg) > 0.01 || std::abs(m.range_m) > 0.002)
      ++unexplained;
    else
      ++(std::abs(rules_deg) <= 0.01 ? within : explained);
  }
  std::printf(
      "%zu points: %d within 0.01 degree as they are, %d by the reference's rules, %d "
      "unexplained; worst %.1e m, %.4f degree\n",
      cloud.size(), within, explained, unexplained, worst_range_m, worst_azimuth_deg);
  EXPECT_EQ(unexplained, 0);
  EXPECT_GT(within, 14831 / 4);
  EXPECT_LT(worst_range_m, 1e-4);
}

}  // namespace
}  // namespace lilo
