// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/scan_builder.hpp"
#include "tests/sim/rig_fixture.hpp"
#include "tools/sim/block_encoder.hpp"
#include "tools/sim/hdl64_encoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

// Simulator and driver were written apart from each other, both from the manuals. What one encodes
// the other must decode: every return on the surface that its shot met, at its own time.
namespace lilo::sim {
namespace {

constexpr std::int64_t kUtc = 1'700'000'000'123'456'000;
const MotionOptions kDrive{.speed_mps = 20.0, .duration_s = 3.0, .start_in_motion = true};

struct Case {
  const char* name;
  Sensor sensor;
  ReturnMode returns;
  bool two_point;
  bool by_xml;  ///< HDL-64E: the table from db.xml instead of YAML
};

class Keeper : public ScanSink {
 public:
  Scan& exchange(Scan& finished) override {
    scans.push_back(finished);
    finished.clear();
    return finished;
  }
  std::vector<Scan> scans;
};

class DriverAgreement : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) / (std::string("lilo_agree_") + GetParam().name);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static SensorOptions options() {
    SensorOptions options = noiseless(GetParam().sensor);
    options.returns = GetParam().returns;
    options.two_point = GetParam().two_point;
    options.max_range_m = 30.0;
    return options;
  }

  /// Scans that the driver makes of 0.45 s of packets.
  std::vector<Scan> decode(TestRig& rig, DriverCounts& counts) {
    SensorConfig config;
    std::unique_ptr<Encoder> encoder;
    if (GetParam().sensor == Sensor::vlp16 || GetParam().sensor == Sensor::vlp16_hires) {
      encoder = std::make_unique<Vlp16Encoder>(rig.rig());
    } else if (const BlockSensor* sensor = find_block_sensor(GetParam().sensor)) {
      encoder = std::make_unique<BlockEncoder>(rig.rig(), *sensor);
    } else {
      const auto table = make_hdl64_table(GetParam().sensor, GetParam().two_point, 6);
      config.calibration_file = folder_ / (GetParam().by_xml ? "db.xml" : "calibration.yaml");
      GetParam().by_xml
          ? write_calibration_xml(config.calibration_file, table)
          : write_calibration_yaml(config.calibration_file, table, GetParam().two_point);
      encoder = std::make_unique<Hdl64Encoder>(rig.rig(), table, kUtc, 0);
    }
    Scan scan;
    Keeper keeper;
    ScanBuilder builder(config, scan, keeper);
    for (std::int64_t start = 0; start < 450'000'000; start += encoder->period_ns()) {
      const Packet packet = encoder->encode(start);
      PacketView view;
      view.received_ns = kUtc + packet.sent_ns + 120'000;
      view.destination_port = packet.port;
      view.payload = std::as_bytes(std::span(packet.payload));
      builder.feed(view);
    }
    counts = builder.counts();
    return std::move(keeper.scans);
  }

  std::filesystem::path folder_;
};

TEST_P(DriverAgreement, DecodedReturnsLieOnTheSurfaces) {
  TestRig rig(
      options(), kDrive, {{3000.0, 0.0, 0.0}},
      [](Scene& scene) {
        add_quad(scene.fixed, {-400, 7, -1}, {900, 0, 0}, {0, 0, 40}, Material::plaster);
        add_quad(scene.fixed, {-400, -9, -1}, {900, 0, 0}, {0, 0, 40}, Material::plaster);
      },
      kUtc);
  DriverCounts counts;
  const std::vector<Scan> scans = decode(rig, counts);
  EXPECT_EQ(counts.packets_lost, 0U);
  EXPECT_EQ(counts.malformed_packets, 0U);
  ASSERT_GE(counts.scans_complete, 3U);
  std::vector<double> errors;
  for (const Scan& scan : scans) {
    for (const Return& r : scan.returns) {
      const double time_s = static_cast<double>(scan.start_ns + r.t_ns - kUtc) * 1e-9;
      const Vec3 local = Eigen::Vector3f(r.x_m, r.y_m, r.z_m).cast<double>();
      if (local.norm() > 15.0) continue;
      const Vec3 p = rig.path.at(time_s) * local;
      errors.push_back(std::min({std::abs(p.z()), std::abs(p.y() - 7.0), std::abs(p.y() + 9.0)}));
    }
  }
  ASSERT_GT(errors.size(), 30000U);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 1.5e-3);
  // Half a distance step, and 0.01 degrees at 15 m. In dual mode a wide beam may meet two surfaces.
  const double part = GetParam().returns == ReturnMode::dual ? 0.97 : 0.999;
  const bool coarse =  // in 4 mm
      GetParam().sensor == Sensor::vlp32c || GetParam().sensor == Sensor::vls128;
  EXPECT_LT(errors[static_cast<std::size_t>(part * static_cast<double>(errors.size()))],
            coarse ? 4e-3 : 3e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Sensors, DriverAgreement,
    testing::Values(Case{"Vlp16", Sensor::vlp16, ReturnMode::strongest, false, false},
                    Case{"Vlp16Last", Sensor::vlp16, ReturnMode::last, false, false},
                    Case{"Vlp16Dual", Sensor::vlp16, ReturnMode::dual, false, false},
                    Case{"PuckHiRes", Sensor::vlp16_hires, ReturnMode::strongest, false, false},
                    Case{"Vlp32c", Sensor::vlp32c, ReturnMode::strongest, false, false},
                    Case{"Vlp32cDual", Sensor::vlp32c, ReturnMode::dual, false, false},
                    Case{"Hdl32e", Sensor::hdl32e, ReturnMode::strongest, false, false},
                    Case{"Hdl32eDual", Sensor::hdl32e, ReturnMode::dual, false, false},
                    Case{"Vls128", Sensor::vls128, ReturnMode::strongest, false, false},
                    Case{"Vls128Last", Sensor::vls128, ReturnMode::last, false, false},
                    Case{"Vls128Dual", Sensor::vls128, ReturnMode::dual, false, false},
                    Case{"Hdl64S2", Sensor::hdl64_s2, ReturnMode::strongest, false, false},
                    Case{"Hdl64S2Xml", Sensor::hdl64_s2, ReturnMode::strongest, false, true},
                    Case{"Hdl64S2TwoPoint", Sensor::hdl64_s2, ReturnMode::strongest, true, false},
                    Case{"Hdl64S3", Sensor::hdl64_s3, ReturnMode::strongest, false, false},
                    Case{"Hdl64S3TwoPoint", Sensor::hdl64_s3, ReturnMode::strongest, true, false},
                    Case{"Hdl64S3Dual", Sensor::hdl64_s3, ReturnMode::dual, false, false}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

}  // namespace
}  // namespace lilo::sim
