// SPDX-License-Identifier: BSD-3-Clause
// Packets of a known room, made by the manuals' tables, must decode to points on its surfaces.
#include "drivers/sensor_table.hpp"
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <set>
#include <string>

namespace lilo {
namespace {

using test::DriveOptions;
using test::HdlOptions;
using test::Mode;
using test::Outcome;
using test::Room;

constexpr double kStepM = 0.002;

double worst_distance_m(const std::vector<Scan>& scans) {
  double worst = 0.0;
  for (const Scan& scan : scans)
    for (const Return& p : scan.returns) worst = std::max(worst, Room::distance_to_surface_m(p));
  return worst;
}

void expect_order_and_bounds(const std::vector<Scan>& scans) {
  for (const Scan& scan : scans) {
    EXPECT_TRUE(scan.complete);
    EXPECT_TRUE(std::is_sorted(scan.returns.begin(), scan.returns.end(),
                               [](const Return& a, const Return& b) { return a.t_ns < b.t_ns; }));
    EXPECT_GE(scan.returns.front().t_ns, 0);
    EXPECT_LE(scan.returns.back().t_ns, scan.end_ns - scan.start_ns);
    EXPECT_TRUE(std::is_sorted(scan.beams.elevation_rad.begin(),
                               scan.beams.elevation_rad.begin() + scan.beams.ring_count));
    for (const Return& p : scan.returns) {
      ASSERT_LT(p.ring, scan.beams.ring_count);
      ASSERT_GE(p.azimuth_rad, -std::numbers::pi_v<float>);
      ASSERT_LT(p.azimuth_rad, std::numbers::pi_v<float>);
    }
  }
}

struct VlpCase {
  std::string name;
  DriveOptions drive;
  std::uint8_t product = 0x22;
};
void PrintTo(const VlpCase& c, std::ostream* out) { *out << c.name; }

class Vlp16Geometry : public testing::TestWithParam<VlpCase> {};

TEST_P(Vlp16Geometry, PointsLieOnTheRoom) {
  const VlpCase& c = GetParam();
  const double packets_per_turn = 60.0 / c.drive.rpm * (c.drive.mode == Mode::dual ? 1508 : 754);
  const auto packets =
      test::vlp16_packets(static_cast<int>(2.3 * packets_per_turn), c.drive, c.product);
  SensorConfig config;
  config.returns = c.drive.mode == Mode::dual ? ReturnChoice::last : ReturnChoice::both;
  const Outcome out = test::build(packets, config);
  ASSERT_EQ(out.scans.size(), 2U);
  EXPECT_LT(worst_distance_m(out.scans), kStepM);
  expect_order_and_bounds(out.scans);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_EQ(out.status.product_id, c.product);
  EXPECT_NEAR(out.status.rpm, c.drive.rpm, 0.01 * c.drive.rpm);
  // Every firing meets the room: 16 lasers a sequence of 55.296 us.
  const double firings = 60.0 / c.drive.rpm / 55.296e-6 * 16;
  EXPECT_NEAR(static_cast<double>(out.scans[0].returns.size()), firings, 17.0);
  EXPECT_NEAR(static_cast<double>(out.scans[0].end_ns - out.scans[0].start_ns), 60e9 / c.drive.rpm,
              60e3);
}

INSTANTIATE_TEST_SUITE_P(
    Modes, Vlp16Geometry,
    testing::Values(VlpCase{"strongest", {}}, VlpCase{"last", {.mode = Mode::last}},
                    VlpCase{"dual", {.mode = Mode::dual}}, VlpCase{"rpm300", {.rpm = 300}},
                    VlpCase{"rpm1200", {.rpm = 1200}}, VlpCase{"hires", {}, 0x24},
                    VlpCase{"mirrored", {.start_azimuth_deg = 20, .counter_clockwise = true}},
                    VlpCase{"dual_rpm1200", {.rpm = 1200, .mode = Mode::dual}}),
    [](const auto& test_case) { return test_case.param.name; });

// Who takes one echo of a firing takes the first: see Scan::returns.
void expect_order(const Scan& scan, ReturnKind first, ReturnKind second) {
  for (std::size_t i = 1; i < scan.returns.size(); ++i) {
    const Return &before = scan.returns[i - 1], &r = scan.returns[i];
    if (before.t_ns != r.t_ns || before.ring != r.ring) continue;
    ASSERT_EQ(before.kind, first);
    ASSERT_EQ(r.kind, second);
  }
}

TEST(Vlp16Dual, BothEchoesAreKeptAndEqualOnesOnce) {
  const auto packets = test::vlp16_packets(350, {.mode = Mode::dual});
  const Outcome out = test::build(packets);
  ASSERT_EQ(out.scans.size(), 2U);
  std::size_t glass = 0, wall = 0, both = 0;
  for (const Return& p : out.scans[0].returns) {
    if (p.kind == ReturnKind::strongest) {
      ++glass;
      EXPECT_LT(Room::distance_to_glass_m(p), kStepM);
    } else {
      wall += p.kind == ReturnKind::last ? 1U : 0U;
      both += p.kind == ReturnKind::both ? 1U : 0U;
      EXPECT_LT(Room::distance_to_surface_m(p), kStepM);
    }
  }
  EXPECT_GT(glass, 1000U);
  EXPECT_EQ(glass, wall);  // each pane echo has a wall behind it
  EXPECT_GT(both, 1000U);
  expect_order(out.scans[0], ReturnKind::last, ReturnKind::strongest);
}

TEST(Vlp16Dual, ChoiceOfReturnsIsKept) {
  const auto packets = test::vlp16_packets(350, {.mode = Mode::dual});
  SensorConfig config;
  config.returns = ReturnChoice::strongest;
  const Outcome strongest = test::build(packets, config);
  config.returns = ReturnChoice::last;
  const Outcome last = test::build(packets, config);
  ASSERT_EQ(strongest.scans.size(), 2U);
  ASSERT_EQ(last.scans.size(), 2U);
  EXPECT_EQ(strongest.scans[0].returns.size(), last.scans[0].returns.size());
  for (const Return& p : strongest.scans[0].returns) EXPECT_NE(p.kind, ReturnKind::last);
  for (const Return& p : last.scans[0].returns) EXPECT_NE(p.kind, ReturnKind::strongest);
}

TEST(Vlp16, RangeLimitsLeaveOutWhatIsBeyond) {
  SensorConfig config;
  config.min_range_m = 3.0;
  config.max_range_m = 5.5;
  const Outcome out = test::build(test::vlp16_packets(170, {}), config);
  ASSERT_GE(out.scans.size(), 1U);
  ASSERT_GT(out.scans[0].returns.size(), 1000U);
  for (const Return& p : out.scans[0].returns) {
    const auto range_m = static_cast<double>(std::hypot(p.x_m, p.y_m, p.z_m));
    EXPECT_GT(range_m, 3.0 - 0.013);  // the origin is up to 12 mm off
    EXPECT_LT(range_m, 5.5 + 0.013);
  }
}

struct HdlCase {
  std::string name;
  HdlOptions options;
};
void PrintTo(const HdlCase& c, std::ostream* out) { *out << c.name; }

class Hdl64eGeometry : public testing::TestWithParam<HdlCase> {};

TEST_P(Hdl64eGeometry, PointsLieOnTheRoom) {
  const HdlCase& c = GetParam();
  const std::string file = testing::TempDir() + "/geometry_" + c.name + ".yaml";
  ASSERT_TRUE(store_calibration(file, c.options.calibration));
  SensorConfig config;
  config.calibration_file = file;
  config.min_range_m = 0.1;
  const bool dual = c.options.drive.mode == Mode::dual;
  config.returns = dual ? ReturnChoice::last : ReturnChoice::both;
  const double packet_s = (c.options.s3 ? 57.6e-6 : 48e-6) * (dual ? 3 : 6);
  const int count = static_cast<int>(1.3 * 60.0 / c.options.drive.rpm / packet_s);
  const Outcome out = test::build(test::hdl64e_packets(count, c.options), config);
  ASSERT_EQ(out.scans.size(), 1U);
  EXPECT_LT(worst_distance_m(out.scans), kStepM);
  expect_order_and_bounds(out.scans);
  EXPECT_EQ(out.scans[0].beams.ring_count, 64);
  std::set<int> rings;
  for (const Return& p : out.scans[0].returns) rings.insert(p.ring);
  EXPECT_EQ(rings.size(), 64U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_NEAR(out.status.packet_period_us, packet_s * 1e6, 1e-6);
  const double firings = 60.0 / c.options.drive.rpm / (c.options.s3 ? 57.6e-6 : 48e-6) * 64;
  EXPECT_NEAR(static_cast<double>(out.scans[0].returns.size()), firings, 65.0);
}

INSTANTIATE_TEST_SUITE_P(
    Modes, Hdl64eGeometry,
    testing::Values(HdlCase{"s2", {.calibration = test::sample_calibration(false)}},
                    HdlCase{"s2_two_point", {.calibration = test::sample_calibration(true)}},
                    HdlCase{"s2_rpm1200",
                            {.drive = {.rpm = 1200, .start_azimuth_deg = 300},
                             .calibration = test::sample_calibration(true)}},
                    HdlCase{"s3", {.calibration = test::sample_calibration(true), .s3 = true}},
                    HdlCase{"s3_dual",
                            {.drive = {.mode = Mode::dual},
                             .calibration = test::sample_calibration(true),
                             .s3 = true}}),
    [](const auto& test_case) { return test_case.param.name; });

TEST(Hdl64eDual, BothEchoesAreKeptAndEqualOnesOnce) {
  const HdlOptions options{.drive = {.rpm = 1200, .mode = Mode::dual},
                           .calibration = test::sample_calibration(true),
                           .s3 = true};
  const std::string file = testing::TempDir() + "/dual.yaml";
  ASSERT_TRUE(store_calibration(file, options.calibration));
  SensorConfig config;
  config.calibration_file = file;
  const Outcome out = test::build(test::hdl64e_packets(350, options), config);
  ASSERT_EQ(out.scans.size(), 1U);
  std::size_t glass = 0, wall = 0;
  for (const Return& p : out.scans[0].returns) {
    glass += p.kind == ReturnKind::strongest ? 1U : 0U;
    wall += p.kind == ReturnKind::last ? 1U : 0U;
    if (p.kind == ReturnKind::strongest)
      EXPECT_LT(Room::distance_to_glass_m(p), kStepM);
    else
      EXPECT_LT(Room::distance_to_surface_m(p), kStepM);
  }
  EXPECT_GT(glass, 1000U);
  EXPECT_EQ(glass, wall);
  expect_order(out.scans[0], ReturnKind::strongest, ReturnKind::last);
}

// S2 manual, firing time table: laser 5 is the second of the second group.
TEST(Hdl64eTimes, FollowTheManualsTable) {
  const HdlOptions options{.drive = {.rpm = 1200, .start_azimuth_deg = 300},
                           .calibration = test::sample_calibration(false)};
  const std::string file = testing::TempDir() + "/times.yaml";
  ASSERT_TRUE(store_calibration(file, options.calibration));
  SensorConfig config;
  config.calibration_file = file;
  const Outcome out = test::build(test::hdl64e_packets(230, options), config);
  ASSERT_EQ(out.scans.size(), 1U);
  std::set<int> offsets_ns;
  for (const Return& p : out.scans[0].returns) offsets_ns.insert(p.t_ns % 48000);
  std::set<int> expected_ns;
  for (int group = 0; group < 8; ++group)
    for (const int laser_ns : {0, 1260, 2460, 3660}) expected_ns.insert(group * 6000 + laser_ns);
  EXPECT_EQ(offsets_ns, expected_ns);
}

// Manual: 24 or, in dual mode, 12 firing sequences of 55.296 us a packet.
TEST(Vlp16, PacketPeriodFollowsTheMode) {
  EXPECT_DOUBLE_EQ(test::build(test::vlp16_packets(2, {})).status.packet_period_us, 1327.104);
  EXPECT_DOUBLE_EQ(
      test::build(test::vlp16_packets(2, {.mode = Mode::dual})).status.packet_period_us, 663.552);
}

TEST(FiringTimes, AreChosenByThePacketPeriod) {
  const SensorTable& hdl64e = *find_sensor(SensorModel::hdl64e);
  EXPECT_EQ(find_firing_times(hdl64e, 288.0e3, false)->cycle_ns, 48000);
  EXPECT_EQ(find_firing_times(hdl64e, 345.6e3, false)->cycle_ns, 57600);
  EXPECT_EQ(find_firing_times(hdl64e, 172.8e3, true)->cycle_ns, 57600);
  EXPECT_EQ(find_firing_times(hdl64e, 144.0e3, true)->cycle_ns, 48000);
  EXPECT_EQ(find_firing_times(hdl64e, 288.0e3 * 1.039, false)->cycle_ns, 48000);
  EXPECT_EQ(find_firing_times(hdl64e, 288.0e3 * 1.05, false), nullptr);
  EXPECT_EQ(find_firing_times(hdl64e, 200.0e3, false), nullptr);
  EXPECT_EQ(find_firing_times(hdl64e, 0.0, false), nullptr);
}

}  // namespace
}  // namespace lilo
