// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/vlp16_encoder.hpp"

#include "tests/sim/rig_fixture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

// The decoding in this file is written from the VLP-16 manual (63-9243), not from the encoder.
namespace lilo::sim {
namespace {

const std::vector<RouteSegment> kStraight{{600.0, 0.0, 0.0}};
const MotionOptions kDrive{.speed_mps = 10.0, .duration_s = 6.0, .start_in_motion = true};

/// A return in the sensor frame at its own firing.
struct Decoded {
  Vec3 point;
  double time_s;
  std::size_t channel;
};

/// Manual, sections 7 and 9: single-return packets.
std::vector<Decoded> decode(const Packet& packet, const Packet& next, double start_s) {
  constexpr std::array<double, 16> kElevation{-15, 1, -13, 3,  -11, 5,  -9, 7,
                                              -7,  9, -5,  11, -3,  13, -1, 15};
  std::vector<Decoded> points;
  for (std::size_t block = 0; block < 12; ++block) {
    const double from = u16_at(packet, block * 100 + 2) * 0.01;
    const double to = (block < 11 ? u16_at(packet, block * 100 + 102) : u16_at(next, 2)) * 0.01;
    const double step = std::fmod(to - from + 360.0, 360.0);
    for (std::size_t channel = 0; channel < 32; ++channel) {
      const unsigned raw = u16_at(packet, block * 100 + 4 + 3 * channel);
      if (raw == 0) continue;
      const double after_us =
          (channel >= 16 ? 55.296 : 0.0) + 2.304 * static_cast<double>(channel % 16);
      const double a = (from + step * after_us / 110.592) * std::numbers::pi / 180.0;
      const double w = kElevation[channel % 16] * std::numbers::pi / 180.0, r = raw * 0.002;
      points.push_back({{r * std::cos(w) * std::cos(a), -r * std::cos(w) * std::sin(a),
                         r * std::sin(w) - 0.04191 * std::tan(w)},
                        start_s + (static_cast<double>(block) * 110.592 + after_us) * 1e-6,
                        channel % 16});
    }
  }
  return points;
}

/// Decodes `count` packets that follow each other and hands on every return in the world frame.
template <typename Visit>
void for_each_return(TestRig& rig, int count, Visit&& visit) {
  Vlp16Encoder encoder(rig.rig());
  Packet packet = encoder.encode(0);
  for (int k = 0; k < count; ++k) {
    const std::int64_t start = k * encoder.period_ns();
    Packet next = encoder.encode(start + encoder.period_ns());
    for (const Decoded& d : decode(packet, next, static_cast<double>(start) * 1e-9)) {
      visit(Vec3(rig.path.at(d.time_s) * d.point), d);
    }
    packet = std::move(next);
  }
}

TEST(Vlp16Encoder, LayoutIsTheManuals) {
  TestRig rig(noiseless(), kDrive, kStraight, [](Scene&) {});
  Vlp16Encoder encoder(rig.rig());
  EXPECT_EQ(encoder.period_ns(), 1'327'104);
  const std::int64_t start = 5 * encoder.period_ns();
  const Packet packet = encoder.encode(start);
  ASSERT_EQ(packet.payload.size(), 1206U);
  EXPECT_EQ(packet.port, 2368);
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(packet.payload[block * 100], 0xFF);
    EXPECT_EQ(packet.payload[block * 100 + 1], 0xEE);
    // The block's azimuth is that of its first firing, to the encoder's 0.01 degrees.
    const double time = static_cast<double>(start) * 1e-9 + static_cast<double>(block) * 110.592e-6;
    const double error =
        u16_at(packet, block * 100 + 2) * 0.01 - std::fmod(rig.rotor.azimuth_deg(time), 360.0);
    EXPECT_LT(std::abs(error), 0.00501);
  }
  // 1 700 000 000 s is 13 min 20 s past an hour.
  EXPECT_EQ(u32_at(packet, 1200), 800'000'000U + 5U * 1'327'104U / 1000U);
  EXPECT_EQ(packet.payload[1204], 0x37);
  EXPECT_EQ(packet.payload[1205], 0x22);
}

TEST(Vlp16Encoder, ModeAndProductBytes) {
  for (const auto& [mode, byte] : {std::pair{ReturnMode::strongest, 0x37},
                                   {ReturnMode::last, 0x38},
                                   {ReturnMode::dual, 0x39}}) {
    SensorOptions options = noiseless(Sensor::vlp16_hires);
    options.returns = mode;
    TestRig rig(options, kDrive, kStraight, [](Scene&) {});
    const Packet packet = Vlp16Encoder(rig.rig()).encode(0);
    EXPECT_EQ(packet.payload[1204], byte);
    EXPECT_EQ(packet.payload[1205], 0x24);
  }
}

TEST(Vlp16Encoder, ReturnsLieOnThePlaneAndTheCylinder) {
  constexpr double kRadius = 0.4;
  const Vec3 foot(6.0, 3.0, 0.0);
  TestRig rig(noiseless(), kDrive, {{60.0, 0.0, 0.0}, {540.0, 0.01, 0.01}}, [&](Scene& scene) {
    add_frustum(scene.fixed, foot, foot + Vec3(0, 0, 6), kRadius, kRadius, 512, Material::bark);
  });
  int on_plane = 0, on_cylinder = 0;
  for_each_return(rig, 150, [&](const Vec3& p, const Decoded& d) {
    if (d.point.norm() > 20.0) return;  // 0.01 degrees are 3.5 mm there
    const double from_axis = (p - foot).head<2>().norm();
    if (from_axis < 1.0 && p.z() > 0.05) {
      EXPECT_NEAR(from_axis, kRadius, 2e-3);
      ++on_cylinder;
    } else {
      EXPECT_NEAR(p.z(), 0.0, 2e-3);
      ++on_plane;
    }
  });
  EXPECT_GT(on_plane, 5000);
  EXPECT_GT(on_cylinder, 100);
}

// At 50 m/s towards a slanted wall a laser cast 2.3 us off its time is 0.1 mm off, and one cast
// with the azimuth of its neighbour 2 mm; averages over many returns see both.
TEST(Vlp16Encoder, EveryLaserIsCastAtItsOwnTimeAndAzimuth) {
  const MotionOptions fast{.speed_mps = 50.0, .duration_s = 4.0, .start_in_motion = true};
  const Vec3 normal = Vec3(1.0, -0.5, 0.0).normalized();
  const Vec3 wall_at(60.0, 0.0, 0.0);
  TestRig rig(noiseless(), fast, {{2000.0, 0.0, 0.0}}, [&](Scene& scene) {
    scene.terrain = {};  // nothing but the wall
    const Vec3 along = Vec3(0.5, 1.0, 0.0).normalized() * 400.0;
    add_quad(scene.fixed, wall_at - 0.5 * along - Vec3(0, 0, 40), along, {0, 0, 80},
             Material::plaster);
  });
  std::array<double, 16> sum{};
  std::array<int, 16> count{};
  for_each_return(rig, 450, [&](const Vec3& p, const Decoded& d) {
    const double error = (p - wall_at).dot(normal);
    sum[d.channel] += error;
    ++count[d.channel];
  });
  for (std::size_t k = 0; k < 16; ++k) {
    ASSERT_GT(count[k], 300);
    EXPECT_LT(std::abs(sum[k] / count[k]), 3e-4) << "channel " << k;
  }
}

TEST(Vlp16Encoder, DualPairsShareTheirAzimuthAndOrder) {
  SensorOptions options = noiseless();
  options.returns = ReturnMode::dual;
  // A grid of thin slats before a wall: many beams split.
  TestRig rig(options, kDrive, kStraight, [](Scene& scene) {
    for (int k = -200; k < 200; ++k) {
      add_quad(scene.fixed, {-300, 0.05 * k, 0}, {0, 0.02, 0}, {0, 0, 8}, Material::bark);
      add_quad(scene.fixed, {0.05 * k, 6.0, 0}, {0.02, 0, 0}, {0, 0, 8}, Material::bark);
    }
    add_quad(scene.fixed, {-100, 12, 0}, {200, 0, 0}, {0, 0, 20}, Material::plaster);
  });
  Vlp16Encoder encoder(rig.rig());
  EXPECT_EQ(encoder.period_ns(), 663'552);
  int same = 0, split = 0;
  for (int n = 0; n < 150; ++n) {
    const Packet packet = encoder.encode(n * encoder.period_ns());
    for (std::size_t block = 0; block < 12; block += 2) {
      EXPECT_EQ(u16_at(packet, block * 100 + 2), u16_at(packet, block * 100 + 102));
      for (std::size_t channel = 0; channel < 32; ++channel) {
        const unsigned last = u16_at(packet, block * 100 + 4 + 3 * channel);
        const unsigned other = u16_at(packet, block * 100 + 104 + 3 * channel);
        EXPECT_GE(last, other);  // the even block's return is the last one
        EXPECT_EQ(last == 0, other == 0);
        (last == other ? same : split) += last != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(split, 500);
  EXPECT_GT(same, 5000);
}

// The face of a box 1 m behind: the rays at 180 degrees meet it in a plane with its normal.
TEST(Vlp16Encoder, APartOfTheRobotMovesAndTurnsWithTheSensor) {
  SensorOptions options = noiseless();
  options.robot = {{-1.5, -1.0, -0.5, 0.5, -1.0, 1.0}};
  const MotionOptions turning{.speed_mps = 10.0, .start_in_motion = true, .turn_rate_dps = 90.0};
  TestRig rig(options, turning, kStraight, [](Scene&) {});
  Vlp16Encoder encoder(rig.rig());
  int seen = 0;
  for (int n = 0; n < 750; ++n) {
    const Packet packet = encoder.encode(n * encoder.period_ns());
    for (std::size_t block = 0; block < 12; ++block) {
      const double azimuth_deg = u16_at(packet, block * 100 + 2) * 0.01;
      if (std::abs(azimuth_deg - 180.0) > 0.3) continue;
      ++seen;
      EXPECT_NEAR(u16_at(packet, block * 100 + 4) * 0.002,
                  1.0 / std::cos(15.0 * std::numbers::pi / 180.0), 0.003);
    }
  }
  EXPECT_GT(seen, 10);
}

TEST(Vlp16Encoder, BlindSectorIsEmptyAndNothingElseIs) {
  SensorOptions options = noiseless();
  options.blind_from_deg = 350.0;
  options.blind_to_deg = 370.0;  // across the zero
  TestRig rig(options, kDrive, kStraight, [](Scene&) {});
  Vlp16Encoder encoder(rig.rig());
  for (int n = 0; n < 80; ++n) {
    const Packet packet = encoder.encode(n * encoder.period_ns());
    for (std::size_t block = 0; block < 12; ++block) {
      const double azimuth = u16_at(packet, block * 100 + 2) * 0.01;
      const unsigned lowest =
          u16_at(packet, block * 100 + 4);  // -15 degrees: always sees the ground
      if (azimuth > 350.1 || azimuth < 9.5) {
        EXPECT_EQ(lowest, 0U);
      } else if (azimuth < 349.5 && azimuth > 10.1) {
        EXPECT_GT(lowest, 0U);
      }
    }
  }
}

}  // namespace
}  // namespace lilo::sim
