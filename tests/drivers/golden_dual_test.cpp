// A real VLP-16 in dual return mode against the cloud an independent decoder made of its packets.
#include "tests/drivers/bag.hpp"
#include "tests/drivers/data_dir.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
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

constexpr double kTicksPerUs = 3594.4e-6 * 100.0;  // how fast this head turned: 599 rpm

// Where the reference's azimuths are not ours, by the block and laser its time stamps name (they
// count 110.592 us a block from the packet's start, also for the two blocks of one shot):
// - in the last shot it does not turn the head between lasers;
// - the second echo of a pair that differs gets the azimuth of the shot after, not turned either.
double reference_error_deg(const Expected& e) {
  const double t_us = e.time_stamp * 1e-3 + 0.5;
  const int block = static_cast<int>(t_us / 110.592);
  const double delay_us = t_us - block * 110.592;
  const double error_us = block >= 10 ? -delay_us : (block % 2 == 1 ? 110.592 - delay_us : 0.0);
  return error_us * kTicksPerUs * 0.01;
}

struct Match {
  double azimuth_deg = 180.0, range_m = 100.0;  // ours less the reference's
};

Match best_match(const Expected& e, const std::vector<Polar>& candidates) {
  const double azimuth_deg =
      static_cast<double>(e.azimuth) * 180.0 / std::numbers::pi - reference_error_deg(e);
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

// Besides, the reference turns the head by the step to the next block, which has the noise of the
// encoder (0.01 degree or two), where ours uses the packet's mean step.
TEST(RealVlp16Dual, EveryPointOfTheReferenceIsFound) {
  LILO_NEED_DATA(kBag);
  LILO_NEED_DATA(kCloud);
  const auto cloud = read_cloud();
  ASSERT_EQ(cloud.size(), 14831U);
  const test::Outcome out = test::build(test::packets_of_bag(test::data_path(kBag)));
  ASSERT_EQ(out.scans.size(), 3U);
  const Scan& scan = out.scans.back();
  std::array<std::vector<Polar>, 16> rings;
  for (const Return& r : scan.returns) rings[r.ring].push_back(polar_of(r, scan.beams));
  int within = 0;
  double worst_range_m = 0.0, worst_azimuth_deg = 0.0;
  for (const Expected& e : cloud) {
    ASSERT_LT(e.channel, 16);
    const Match m = best_match(e, rings[e.channel]);
    worst_range_m = std::max(worst_range_m, std::abs(m.range_m));
    worst_azimuth_deg = std::max(worst_azimuth_deg, std::abs(m.azimuth_deg));
    within += std::abs(m.azimuth_deg) <= 0.01 ? 1 : 0;
  }
  EXPECT_LT(worst_range_m, 1e-4);
  EXPECT_LT(worst_azimuth_deg, 0.03);
  EXPECT_GT(within, 14831 * 95 / 100);
}

}  // namespace
}  // namespace lilo
