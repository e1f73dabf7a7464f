// SPDX-License-Identifier: BSD-3-Clause
// VLP-32C, HDL-32E and VLS-128: packets of a known room must decode to points on its surfaces, at
// the manuals' times, and losses must be counted to the packet.
#include "drivers/packet_decoder.hpp"
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <set>
#include <span>
#include <string>

namespace lilo {
namespace {

using test::Mode;
using test::Outcome;
using test::Room;
using test::RowOptions;

struct RowCase {
  std::string name;
  RowOptions options;
};
void PrintTo(const RowCase& c, std::ostream* out) { *out << c.name; }

double step_m(const RowOptions& o) { return o.model == SensorModel::hdl32e ? 0.002 : 0.004; }
double cycle_us(const RowOptions& o) {
  if (o.model == SensorModel::vls128) return o.vls128_cycle_us;
  return o.model == SensorModel::hdl32e ? 46.08 : 55.296;
}
int packets_in(const RowOptions& o, double turns) {
  return static_cast<int>(turns * 60e6 / o.drive.rpm / test::row_packet_us(o));
}

class RowSensor : public testing::TestWithParam<RowCase> {};

TEST_P(RowSensor, PointsLieOnTheRoom) {
  const RowOptions& o = GetParam().options;
  const SensorTable& table = *find_sensor(o.model);
  SensorConfig config;
  config.returns = o.drive.mode == Mode::dual ? ReturnChoice::last : ReturnChoice::both;
  const Outcome out = test::build(test::row_packets(packets_in(o, 2.3), o), config);
  ASSERT_EQ(out.scans.size(), 2U);
  EXPECT_EQ(out.status.model, o.model);
  EXPECT_EQ(out.status.product_id, table.product);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_NEAR(out.status.rpm, o.drive.rpm, 0.03 * o.drive.rpm);
  for (const Scan& scan : out.scans) {
    EXPECT_TRUE(scan.complete);
    EXPECT_EQ(scan.beams.ring_count, table.lasers);
    std::set<int> rings;
    double worst_m = 0.0;
    for (std::size_t i = 0; i < scan.returns.size(); ++i) {
      const Return& r = scan.returns[i];
      rings.insert(r.ring);
      worst_m = std::max(worst_m, Room::distance_to_surface_m(r));
      ASSERT_GE(r.t_ns, i > 0 ? scan.returns[i - 1].t_ns : 0);
    }
    EXPECT_EQ(static_cast<int>(rings.size()), table.lasers);
    // Half a step, and the encoder's tick of 0.01 degree at 8 m.
    EXPECT_LT(worst_m, 0.5 * step_m(o) + 0.0012);
  }
  const double firings = 60e6 / o.drive.rpm / cycle_us(o) * table.lasers;
  EXPECT_NEAR(static_cast<double>(out.scans[0].returns.size()), firings, table.lasers + 1.0);
}

TEST_P(RowSensor, EveryLossIsCounted) {
  const RowOptions& o = GetParam().options;
  std::mt19937 random(3);
  auto packets = test::row_packets(packets_in(o, 2.2), o);
  std::vector<test::TimedPacket> kept;
  std::uint64_t lost = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const bool burst = i % 97 > 80 && i > 100;
    const bool last_few = i + 5 > packets.size();  // nothing after them would tell
    if (i > 3 && !last_few && (burst || random() % 50 == 0)) {
      ++lost;
    } else {
      kept.push_back(packets[i]);
    }
  }
  ASSERT_GT(lost, 5U);
  const Outcome out = test::build(kept);
  EXPECT_EQ(out.counts.packets_lost, lost);
  for (const Scan& scan : out.scans)
    EXPECT_EQ(scan.packets.expected, scan.packets.received + scan.packets.lost);
}

INSTANTIATE_TEST_SUITE_P(
    Modes, RowSensor,
    testing::Values(
        RowCase{"vlp32c", {.model = SensorModel::vlp32c}},
        RowCase{"vlp32c_last", {.model = SensorModel::vlp32c, .drive = {.mode = Mode::last}}},
        RowCase{"vlp32c_dual", {.model = SensorModel::vlp32c, .drive = {.mode = Mode::dual}}},
        RowCase{"vlp32c_rpm1200", {.model = SensorModel::vlp32c, .drive = {.rpm = 1200}}},
        RowCase{"hdl32e", {.model = SensorModel::hdl32e}},
        RowCase{"hdl32e_dual", {.model = SensorModel::hdl32e, .drive = {.mode = Mode::dual}}},
        RowCase{"hdl32e_mirrored",
                {.model = SensorModel::hdl32e,
                 .drive = {.start_azimuth_deg = 20, .counter_clockwise = true}}},
        RowCase{"vls128", {.model = SensorModel::vls128, .drive = {.rpm = 1200}}},
        RowCase{"vls128_manual_cycle",
                {.model = SensorModel::vls128, .drive = {.rpm = 1200}, .vls128_cycle_us = 53.3}},
        RowCase{"vls128_later_firmware",
                {.model = SensorModel::vls128, .drive = {.rpm = 1200}, .vls128_cycle_us = 57.8}},
        RowCase{"vls128_dual",
                {.model = SensorModel::vls128, .drive = {.rpm = 1200, .mode = Mode::dual}}},
        RowCase{"vls128_confirmed",
                {.model = SensorModel::vls128,
                 .drive = {.rpm = 1200, .mode = Mode::dual},
                 .dual_byte = 0x3B}}),
    [](const auto& test_case) { return test_case.param.name; });

TEST(RowSensorDual, BothEchoesAreKeptAndEqualOnesOnce) {
  for (const SensorModel model : {SensorModel::vlp32c, SensorModel::hdl32e, SensorModel::vls128}) {
    const RowOptions o{.model = model, .drive = {.rpm = 1200, .mode = Mode::dual}};
    const Outcome out = test::build(test::row_packets(packets_in(o, 1.3), o));
    ASSERT_EQ(out.scans.size(), 1U);
    EXPECT_EQ(out.status.return_mode, ReturnMode::dual);
    std::size_t glass = 0, wall = 0, both = 0;
    for (const Return& p : out.scans[0].returns) {
      glass += p.kind == ReturnKind::strongest ? 1U : 0U;
      wall += p.kind == ReturnKind::last ? 1U : 0U;
      both += p.kind == ReturnKind::both ? 1U : 0U;
      const bool on_glass = p.kind == ReturnKind::strongest;
      EXPECT_LT(on_glass ? Room::distance_to_glass_m(p) : Room::distance_to_surface_m(p), 0.0035);
    }
    EXPECT_GT(glass, 1000U);
    EXPECT_EQ(glass, wall);
    EXPECT_GT(both, 1000U);
  }
}

// Manuals, firing times: how long after the first laser the others of a cycle fire.
TEST(RowSensorTimes, FollowTheManuals) {
  const auto offsets = [](SensorModel model) {
    const RowOptions o{.model = model, .drive = {.rpm = 1200}};
    const Outcome out = test::build(test::row_packets(packets_in(o, 1.3), o));
    std::set<int> times_ns;
    for (const Return& r : out.scans.at(0).returns)
      if (r.t_ns < 46'000) times_ns.insert(r.t_ns);
    return times_ns;
  };
  std::set<int> vlp32c, hdl32e, vls128;
  for (int k = 0; k < 16; ++k) vlp32c.insert(2304 * k);
  for (int k = 0; k < 32; ++k) hdl32e.insert(1152 * k);
  for (int k = 0; k < 16; ++k) vls128.insert(2665 * (k < 8 ? k : k + 1));
  EXPECT_EQ(offsets(SensorModel::vlp32c), vlp32c);
  EXPECT_EQ(offsets(SensorModel::hdl32e), hdl32e);
  EXPECT_EQ(offsets(SensorModel::vls128), vls128);
}

// Manual, appendix E: -542.592 us + 46.08 us times the block after the stamp.
TEST(RowSensorTimes, AnHdl32eIsStampedAtThePacketsEnd) {
  const auto packets = test::row_packets(1, {.model = SensorModel::hdl32e});
  const AzimuthTable azimuths;
  PacketDecoder decoder({}, azimuths);
  decoder.use(*find_sensor(SensorModel::hdl32e));
  const std::span<const std::byte> bytes = packets[0].bytes;
  ASSERT_TRUE(decoder.load(bytes.first<wire::kDataPacketBytes>()));
  ASSERT_EQ(decoder.columns().size(), 12U);
  for (std::int32_t block = 0; block < 12; ++block) {
    const Column& column = decoder.columns()[static_cast<std::size_t>(block)];
    EXPECT_EQ(column.first_ns, -542'592 + 46'080 * block);
    EXPECT_EQ(column.last_ns, column.first_ns + 31 * 1'152);
  }
}

TEST(RowSensor, MalformedPacketsAreCountedAndLeftOut) {
  for (const SensorModel model : {SensorModel::vlp32c, SensorModel::hdl32e, SensorModel::vls128}) {
    const RowOptions o{.model = model, .drive = {.rpm = 1200}};
    const auto good = test::row_packets(packets_in(o, 1.5), o);
    for (std::size_t block = 0; block < 12; ++block) {
      for (const bool flag : {true, false}) {
        auto packets = good;
        auto& bytes = packets[40].bytes;
        bytes[100 * block + (flag ? 0 : 3)] = flag ? std::byte{0x12} : std::byte{0xFF};
        const Outcome out = test::build(packets);
        EXPECT_EQ(out.counts.malformed_packets, 1U) << block;
        EXPECT_EQ(out.counts.packets_lost, 1U) << block;
        EXPECT_EQ(out.counts.data_packets, packets.size() - 1);
      }
    }
  }
}

}  // namespace
}  // namespace lilo
