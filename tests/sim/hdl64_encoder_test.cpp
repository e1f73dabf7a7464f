// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/hdl64_encoder.hpp"

#include "tests/sim/rig_fixture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

// The decoding in this file is written from the HDL-64E S3 manual (63-HDL64ES3 rev. K).
namespace lilo::sim {
namespace {

constexpr std::int64_t kUtc = 1'700'000'000'000'000'000;  // 13 min 20 s past an hour
const std::vector<RouteSegment> kStraight{{3000.0, 0.0, 0.0}};
const MotionOptions kDrive{.speed_mps = 25.0, .duration_s = 3.0, .start_in_motion = true};

/// Timing of one shot after the packet's first: firing `pair` of the packet, channel in its bank.
double shot_us(bool s2, std::size_t pair, std::size_t channel) {
  constexpr std::array<double, 4> kS2{0.0, 1.26, 2.46, 3.66}, kS3{0.0, 1.3, 2.5, 3.7};
  const std::size_t fourth = channel / 4;
  const auto p = static_cast<double>(pair), group = static_cast<double>(fourth);
  return s2 ? 48.0 * p + 6.0 * group + kS2[channel % 4] : 57.6 * p + 7.2 * group + kS3[channel % 4];
}

/// Appendix "dual two point calibration", in the manual's axes (x right, y ahead), then turned to
/// ours.
Vec3 manual_point(const LaserCorrection& c, unsigned raw, double azimuth_rad, bool two_point) {
  const double rot = azimuth_rad - c.rotation_rad, vert = c.elevation_rad;
  const double distance1 = raw * 0.002, distance = distance1 + c.distance_m;
  const double xy = distance * std::cos(vert);
  const double xx = std::abs(xy * std::sin(rot) - c.horizontal_offset_m * std::cos(rot));
  const double yy = std::abs(xy * std::cos(rot) + c.horizontal_offset_m * std::sin(rot));
  double corr_x = c.distance_m, corr_y = c.distance_m;
  if (two_point && distance < 25.04) {
    corr_x = (c.distance_m - c.distance_x_m) * (xx - 2.40) / (25.04 - 2.40) + c.distance_x_m;
    corr_y = (c.distance_m - c.distance_y_m) * (yy - 1.93) / (25.04 - 1.93) + c.distance_y_m;
  }
  const double x =
      (distance1 + corr_x) * std::cos(vert) * std::sin(rot) - c.horizontal_offset_m * std::cos(rot);
  const double y =
      (distance1 + corr_y) * std::cos(vert) * std::cos(rot) + c.horizontal_offset_m * std::sin(rot);
  return {y, -x, (distance1 + 0.5 * (corr_x + corr_y)) * std::sin(vert) + c.vertical_offset_m};
}

struct Case {
  Sensor sensor;
  ReturnMode returns;
  bool two_point;
};

class Hdl64 : public testing::TestWithParam<Case> {
 protected:
  static SensorOptions options() {
    SensorOptions options = noiseless(GetParam().sensor);
    options.returns = GetParam().returns;
    options.two_point = GetParam().two_point;
    return options;
  }
  static bool is_s2() { return GetParam().sensor == Sensor::hdl64_s2; }
  static bool is_dual() { return GetParam().returns == ReturnMode::dual; }
};

// Between two walls and above the ground, at 25 m/s: 57.6 us early or late would be 1.4 mm, a
// packet 7 mm, a wrong sign of any correction centimetres.
TEST_P(Hdl64, DecodedReturnsLieOnTheSurfaces) {
  TestRig rig(
      options(), kDrive, kStraight,
      [](Scene& scene) {
        add_quad(scene.fixed, {-400, 7, -1}, {900, 0, 0}, {0, 0, 40}, Material::plaster);
        add_quad(scene.fixed, {-400, -9, -1}, {900, 0, 0}, {0, 0, 40}, Material::plaster);
      },
      kUtc);
  const auto table = make_hdl64_table(GetParam().sensor, GetParam().two_point, 4);
  Hdl64Encoder encoder(rig.rig(), table, kUtc, 0);
  int good = 0, seen = 0;
  for (int n = 0; n < 400; ++n) {
    const std::int64_t start = n * encoder.period_ns();
    const Packet packet = encoder.encode(start);
    for (std::size_t block = 0; block < 12; ++block) {
      const double azimuth = u16_at(packet, 100 * block + 2) * 0.01 * std::numbers::pi / 180.0;
      const std::size_t bank = u16_at(packet, 100 * block) == 0xEEFF ? 0 : 32;
      const std::size_t pair = is_dual() ? block / 4 : block / 2;
      for (std::size_t channel = 0; channel < 32; ++channel) {
        const unsigned raw = u16_at(packet, 100 * block + 4 + 3 * channel);
        if (raw == 0) continue;
        const double time =
            static_cast<double>(start) * 1e-9 + shot_us(is_s2(), pair, channel) * 1e-6;
        const Vec3 local = manual_point(table[bank + channel], raw, azimuth, GetParam().two_point);
        if (local.norm() > 20.0) continue;  // 0.01 degrees are 3.5 mm there
        const Vec3 p = rig.path.at(time) * local;
        const double off =
            std::min({std::abs(p.z()), std::abs(p.y() - 7.0), std::abs(p.y() + 9.0)});
        ++seen;
        good += off < 3e-3 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(seen, 50000);
  // Where a beam meets two surfaces at their edge in a dual packet the wide rays miss both by more.
  EXPECT_GE(good, is_dual() ? seen * 97 / 100 : seen - seen / 1000);
}

TEST_P(Hdl64, LayoutIsTheManuals) {
  TestRig rig(
      options(), kDrive, kStraight, [](Scene&) {}, kUtc);
  Hdl64Encoder encoder(rig.rig(), make_hdl64_table(GetParam().sensor, GetParam().two_point, 4),
                       kUtc, 0);
  const std::int64_t period = is_dual() ? 172'800 : is_s2() ? 288'000 : 345'600;
  EXPECT_EQ(encoder.period_ns(), period);
  const Packet packet = encoder.encode(2 * period);
  ASSERT_EQ(packet.payload.size(), 1206U);
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(u16_at(packet, 100 * block), block % 2 == 0 ? 0xEEFFU : 0xDDFFU);
    const std::size_t first = is_dual() ? block / 4 * 4 : block / 2 * 2;
    EXPECT_EQ(u16_at(packet, 100 * block + 2), u16_at(packet, 100 * first + 2));
  }
  EXPECT_EQ(u16_at(packet, 2) == u16_at(packet, 202), is_dual());
  EXPECT_EQ(u32_at(packet, 1200), 800'000'000U + static_cast<std::uint32_t>(3 * period / 1000));
}

INSTANTIATE_TEST_SUITE_P(Models, Hdl64,
                         testing::Values(Case{Sensor::hdl64_s2, ReturnMode::strongest, false},
                                         Case{Sensor::hdl64_s2, ReturnMode::strongest, true},
                                         Case{Sensor::hdl64_s3, ReturnMode::strongest, false},
                                         Case{Sensor::hdl64_s3, ReturnMode::strongest, true},
                                         Case{Sensor::hdl64_s3, ReturnMode::dual, false}),
                         [](const auto& test_case) {
                           std::string name =
                               test_case.param.sensor == Sensor::hdl64_s2 ? "S2" : "S3";
                           if (test_case.param.two_point) name += "TwoPoint";
                           if (test_case.param.returns == ReturnMode::dual) name += "Dual";
                           return name;
                         });

TEST(Hdl64Table, LooksLikeARealUnit) {
  for (const Sensor sensor : {Sensor::hdl64_s2, Sensor::hdl64_s3}) {
    const auto table = make_hdl64_table(sensor, true, 8);
    ASSERT_EQ(table.size(), 64U);
    std::array<int, 64> seen_above{};
    for (std::size_t k = 0; k < 64; ++k) {
      const double up = table[k].elevation_rad * 180.0 / std::numbers::pi;
      EXPECT_TRUE(k < 32 ? up > -8.75 && up < 2.5 : up > -25.2 && up < -8.4) << k << " " << up;
      EXPECT_LT(std::abs(table[k].rotation_rad), 0.19);
      EXPECT_GT(table[k].distance_m, 1.2);
      EXPECT_LT(table[k].distance_m, 1.6);
      EXPECT_EQ(std::abs(table[k].horizontal_offset_m), 0.026);
      for (std::size_t j = 0; j < 64; ++j)
        seen_above[k] += table[j].elevation_rad > table[k].elevation_rad ? 1 : 0;
    }
    // Every unit has its highest beam at id 29 and its lowest at id 38.
    EXPECT_EQ(seen_above[29], 0);
    EXPECT_EQ(seen_above[38], 63);
  }
}

}  // namespace
}  // namespace lilo::sim
