// SPDX-License-Identifier: BSD-3-Clause
// Real VLP-32C and VLS-128 packets against the clouds an independent decoder (tier4/nebula) made of
// them, point by point. Its angle tables are read from its own files.
#include "drivers/calibration.hpp"
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
#include <functional>
#include <iterator>
#include <numbers>
#include <numeric>
#include <ostream>

namespace lilo {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kStepM = 0.004;
constexpr double kSameDeg = 0.01;

struct CloudCase {
  const char* name;
  SensorModel model;
  std::size_t packets, points;
  std::size_t banks;
  double origin_m;
  double cut_deg;
  std::function<double(std::size_t)> turned;  ///< part of a step that the head turned by a laser
};
void PrintTo(const CloudCase& c, std::ostream* out) { *out << c.name; }

double vls128_group(std::size_t laser) {
  const std::size_t bank = laser / 8;
  const auto group = static_cast<double>(bank);
  return group + std::floor(group / 8.0);
}
// Ours turns the head by the measured cycle, the reference by the manual's 53.3 us.
double vlp32c_turn(std::size_t laser) {
  const std::size_t firing = laser / 2;
  return 2.304 * static_cast<double>(firing) / 55.296;
}
double vls128_turn(std::size_t laser) { return 2.665 * vls128_group(laser) / 55.278; }
double vlp32c_reference_turn(std::size_t laser) {
  return 2.304 * static_cast<double>(laser) / 55.296;
}
double vls128_reference_turn(std::size_t laser) { return 2.665 * vls128_group(laser) / 53.3; }

// What the reference makes of a return on the wire, and what the firing time says instead:
// - both: the reference turns the head by the step to the block after, adds the laser's offset and
//   rounds to a tick; it does not turn the head in a packet's last block;
// - VLP-32C: it takes one laser after the other, which would need 71 us of the 55.3 us of a cycle;
// - VLS-128: the block after has the same azimuth but for the last bank of a shot.
// Ours turns it by the packet's mean step and the manual's times: two and eight lasers at a time.
struct WireReturn {
  double reference_deg, own_deg;  // azimuth with the laser's offset
  int steps;
  bool in_scan;  // between the first and the last cut of the recording
};

int azimuth_at(const test::TimedPacket& packet, std::size_t block) {
  return wire::u16(packet.bytes.data() + 100 * block + 2);
}

double step_between(const test::TimedPacket& packet, std::size_t from, std::size_t to) {
  return std::remainder(azimuth_at(packet, to) - azimuth_at(packet, from), 36000.0);
}

// From shot to shot; the median, since one step of a blind sector is far larger.
double typical_step(const test::TimedPacket& packet, std::size_t banks) {
  std::vector<double> steps;
  for (std::size_t b = banks; b < 12; b += banks)
    steps.push_back(step_between(packet, b - banks, b));
  const double mean = std::accumulate(steps.begin(), steps.end(), 0.0) / double(steps.size());
  if (*std::max_element(steps.begin(), steps.end()) < 200.0) return mean;
  std::nth_element(steps.begin(), steps.begin() + std::ptrdiff_t(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

using ByLaser = std::vector<std::vector<WireReturn>>;

void add_packet(const CloudCase& c, const test::TimedPacket& packet, const Calibration& table,
                const std::vector<bool>& in_scan, ByLaser& all) {
  const double step = typical_step(packet, c.banks);
  for (std::size_t b = 0; b < 12; ++b)
    for (std::size_t k = 0; k < 32; ++k) {
      const std::byte* bytes = packet.bytes.data() + 100 * b + 4 + 3 * k;
      const int steps = wire::u16(bytes);
      if (steps == 0) continue;
      const std::size_t laser = b % c.banks * 32 + k;
      const double offset_deg = table.lasers[laser].rot_rad * kDegPerRad;
      const double head = azimuth_at(packet, b);
      const double part =
          c.banks == 4 ? vls128_reference_turn(laser) : vlp32c_reference_turn(laser);
      const double turned = b < 11 ? step_between(packet, b, b + 1) * part : 0.0;
      const double reference = std::round(head + turned - 100.0 * offset_deg);
      all[laser].push_back({.reference_deg = reference * 0.01,
                            .own_deg = (head + step * c.turned(laser)) * 0.01 - offset_deg,
                            .steps = steps,
                            .in_scan = in_scan[b]});
    }
}

// Cuts are where the azimuth passes the configured one; what is before the first and after the last
// is no scan.
std::vector<std::vector<bool>> blocks_in_scans(const std::vector<test::TimedPacket>& packets,
                                               double cut_deg) {
  std::vector<int> cuts_before;
  int cuts = 0, last = 0;
  for (const auto& packet : packets)
    for (std::size_t b = 0; b < 12; ++b) {
      const int azimuth =
          (azimuth_at(packet, b) + 36'000 - static_cast<int>(100.0 * cut_deg)) % 36'000;
      if (azimuth < last - 18'000) ++cuts;
      last = azimuth;
      cuts_before.push_back(cuts);
    }
  std::vector<std::vector<bool>> in(packets.size(), std::vector<bool>(12));
  for (std::size_t i = 0; i < cuts_before.size(); ++i)
    in[i / 12][i % 12] = cuts_before[i] > 0 && cuts_before[i] < cuts;
  return in;
}

struct Xyz {
  float x, y, z;
};

std::vector<Xyz> read_cloud(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string data(std::istreambuf_iterator<char>(in), {});
  const std::string marker = "DATA binary\n";
  const std::size_t begin = data.find(marker) + marker.size();
  std::vector<Xyz> points((data.size() - begin) / sizeof(Xyz));
  std::memcpy(points.data(), data.data() + begin, points.size() * sizeof(Xyz));
  return points;
}

std::size_t nearest_laser(const Calibration& table, double elevation_rad) {
  const auto apart = [&](const LaserCorrection& laser) {
    return std::abs(laser.vert_rad - elevation_rad);
  };
  const auto best =
      std::min_element(table.lasers.begin(), table.lasers.end(),
                       [&](const auto& a, const auto& b) { return apart(a) < apart(b); });
  return static_cast<std::size_t>(best - table.lasers.begin());
}

// An azimuth and a range, clockwise degrees.
struct Polar {
  double azimuth_deg, range_m;
  std::size_t index = 0;
};

double unwrapped(double deg) { return deg - 360.0 * std::floor(deg / 360.0); }

// Those of `sorted` (by azimuth) within `within_deg`, seen once around.
template <typename See>
void visit(const std::vector<Polar>& sorted, double azimuth_deg, double within_deg, See&& see) {
  for (const double turn : {-360.0, 0.0, 360.0}) {
    const double from = unwrapped(azimuth_deg) + turn - within_deg;
    auto at = std::lower_bound(sorted.begin(), sorted.end(), from,
                               [](const Polar& p, double deg) { return p.azimuth_deg < deg; });
    for (; at != sorted.end() && at->azimuth_deg <= from + 2.0 * within_deg; ++at) see(*at);
  }
}

// The nearest one in range; null: none.
const Polar* nearest(const std::vector<Polar>& sorted, Polar wanted, double within_deg) {
  const Polar* best = nullptr;
  const auto apart = [&](const Polar& p) { return std::abs(p.range_m - wanted.range_m); };
  visit(sorted, wanted.azimuth_deg, within_deg, [&](const Polar& p) {
    if (best == nullptr || apart(p) < apart(*best)) best = &p;
  });
  return best;
}

// All to the rounding of a tick and 1 mm.
std::vector<Polar> around(const std::vector<Polar>& sorted, Polar wanted) {
  std::vector<Polar> found;
  visit(sorted, wanted.azimuth_deg, 0.0105, [&](const Polar& p) {
    if (std::abs(p.range_m - wanted.range_m) < 1e-3) found.push_back(p);
  });
  return found;
}

void sort_by_azimuth(std::vector<std::vector<Polar>>& lists) {
  for (auto& list : lists)
    std::sort(list.begin(), list.end(),
              [](const Polar& a, const Polar& b) { return a.azimuth_deg < b.azimuth_deg; });
}

// Our returns by laser, without the height of the beam's origin, which the reference does not know.
std::vector<std::vector<Polar>> decoded(const CloudCase& c, const test::Outcome& out,
                                        const Calibration& table) {
  std::vector<std::vector<Polar>> lists(table.lasers.size());
  for (const Scan& scan : out.scans)
    for (const Return& r : scan.returns) {
      const auto w = static_cast<double>(scan.beams.elevation_rad[r.ring]);
      const double z = static_cast<double>(r.z_m) + c.origin_m * std::tan(w);
      lists[nearest_laser(table, w)].push_back(
          {unwrapped(-static_cast<double>(r.azimuth_rad) * kDegPerRad),
           std::hypot(static_cast<double>(r.x_m), static_cast<double>(r.y_m), z)});
    }
  sort_by_azimuth(lists);
  return lists;
}

class GoldenCloud : public testing::TestWithParam<CloudCase> {};

// Each point of the reference is a return on the wire by its rules, and that return is one of ours,
// at the azimuth that its firing time says.
TEST_P(GoldenCloud, EveryPointIsFoundOrExplained) {
  const CloudCase& c = GetParam();
  const std::string bag = std::string("real/") + c.name + ".db3";
  const std::string pcd = std::string("real/") + c.name + "_expected.pcd";
  const std::string yaml = c.banks == 4 ? "calib/nebula_VLS128.yaml" : "calib/nebula_VLP32.yaml";
  LILO_NEED_DATA(bag);
  LILO_NEED_DATA(pcd);
  const Calibration table = load_calibration(test::data_path(yaml));
  auto packets = test::packets_of_bag(test::data_path(bag));
  ASSERT_EQ(packets.size(), c.packets);
  ByLaser on_wire(table.lasers.size());
  const auto in_scan = blocks_in_scans(packets, c.cut_deg);
  for (std::size_t i = 0; i < packets.size(); ++i)
    add_packet(c, packets[i], table, in_scan[i], on_wire);
  std::vector<std::vector<Polar>> wire_lists(on_wire.size());
  for (std::size_t laser = 0; laser < on_wire.size(); ++laser)
    for (std::size_t i = 0; i < on_wire[laser].size(); ++i)
      wire_lists[laser].push_back(
          {unwrapped(on_wire[laser][i].reference_deg), on_wire[laser][i].steps * kStepM, i});
  sort_by_azimuth(wire_lists);
  SensorConfig config;
  config.min_range_m = 0.0;
  config.max_range_m = 300.0;
  config.cut_azimuth_rad = c.cut_deg / kDegPerRad;
  const test::Outcome out = test::build(packets, config);
  EXPECT_EQ(out.status.model, c.model);
  EXPECT_EQ(out.counts.malformed_packets, 0U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  const auto ours = decoded(c, out, table);
  std::size_t within = 0, explained = 0, unexplained = 0, in_no_scan = 0;
  double worst_range_m = 0.0, most_turn_deg = 0.0;
  const auto cloud = read_cloud(test::data_path(pcd));
  ASSERT_EQ(cloud.size(), c.points);
  for (const Xyz& p : cloud) {
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
    const double z = static_cast<double>(p.z), range_m = std::hypot(x, y, z);
    const std::size_t laser = nearest_laser(table, std::asin(z / range_m));
    const Polar wanted{-std::atan2(y, x) * kDegPerRad, range_m};
    // Another turn may have met the same place: any return that both agree on will do.
    const WireReturn* same = nullptr;
    const Polar* found = nullptr;
    bool all_in_scan = true;
    for (const Polar& wire : around(wire_lists[laser], wanted)) {
      same = &on_wire[laser][wire.index];
      all_in_scan = all_in_scan && same->in_scan;
      found = nearest(ours[laser], {same->own_deg, range_m}, kSameDeg);
      if (found != nullptr && std::abs(found->range_m - range_m) < 1e-4) break;
      found = nullptr;
    }
    if (found == nullptr) {
      ++(all_in_scan ? unexplained : in_no_scan);
      continue;
    }
    worst_range_m = std::max(worst_range_m, std::abs(found->range_m - range_m));
    const double turn_deg = std::abs(std::remainder(same->own_deg - same->reference_deg, 360.0));
    most_turn_deg = std::max(most_turn_deg, turn_deg);
    ++(turn_deg <= 0.01 ? within : explained);
  }
  std::printf(
      "%s: %zu points: %zu within 0.01 degree as they are, %zu by the reference's rules (at "
      "most %.3f degree), %zu before the first or after the last cut, %zu unexplained; worst range "
      "%.1e m\n",
      c.name, cloud.size(), within, explained, most_turn_deg, in_no_scan, unexplained,
      worst_range_m);
  EXPECT_EQ(unexplained, 0U);
  EXPECT_GT(within, c.points / 20);
  EXPECT_LT(worst_range_m, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Real, GoldenCloud,
                         testing::Values(CloudCase{"vlp32c", SensorModel::vlp32c, 379, 26216, 1,
                                                   0.0424, 270.6, vlp32c_turn},
                                         CloudCase{"vls128", SensorModel::vls128, 2193, 208680, 4,
                                                   0.05863, 0.0, vls128_turn}),
                         [](const auto& test_case) { return std::string(test_case.param.name); });

}  // namespace
}  // namespace lilo
