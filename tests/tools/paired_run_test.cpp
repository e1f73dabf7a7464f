// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paired_run.hpp"

#include "tools/bench/paired_report.hpp"
#include "tools/run/odometry_run.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace lilo {
namespace {

const std::string kKitti = std::string(LILO_DATA_DIR) + "/real/kitti_00";

std::vector<StampedPose> poses_alone(Profile profile, std::size_t scans) {
  OdometryConfig config;
  config.profile = profile;
  const auto source = open_scans(kKitti, {});
  auto poses = run_odometry(*source, config, [](const Scan&, const Estimate&) {}).poses;
  poses.resize(scans);
  return poses;
}

/// Taking turns must not change what either profile says.
TEST(PairedRun, EachProfileDoesAsIfItWereAlone) {
  if (!std::filesystem::exists(kKitti)) GTEST_SKIP() << "no " << kKitti;
  constexpr std::size_t kScans = 4;
  const PairedRun run = run_paired(find_sets({kKitti})[0], {}, kScans, [](double) { return true; });
  EXPECT_EQ(run.set, "kitti_00");
  EXPECT_EQ(run.beams, 64);
  EXPECT_EQ(run.decode_ms.size(), kScans);
  EXPECT_TRUE(run.default_profile.ate_m.has_value());
  for (const Profile profile : {Profile::default_profile, Profile::paper}) {
    const ProfileRun& half = profile == Profile::paper ? run.paper : run.default_profile;
    const auto alone = poses_alone(profile, kScans);
    ASSERT_EQ(half.poses.size(), kScans);
    for (std::size_t k = 0; k < kScans; ++k) {
      EXPECT_EQ(half.poses[k].stamp_ns, alone[k].stamp_ns);
      EXPECT_EQ(half.poses[k].pose.translation_m, alone[k].pose.translation_m);
    }
  }
}

TEST(PairedRun, EndsWhenItIsTold) {
  if (!std::filesystem::exists(kKitti)) GTEST_SKIP() << "no " << kKitti;
  const PairedRun run = run_paired(find_sets({kKitti})[0], {}, 0, [](double) { return false; });
  EXPECT_EQ(run.returns.size(), 1U);
}

TEST(PairedReport, WithoutTruthErrorsAreNull) {
  PairedRun run{.set = "drive", .beams = 16, .decode_ms = {1.0, 3.0}, .returns = {10.0, 20.0}};
  run.default_profile.ground = {5.0, 7.0};
  run.default_profile.status_counts = {1, 1, 0, 0};
  const auto json = nlohmann::json::parse(to_json({run}))["sets"][0];
  EXPECT_EQ(json["set"], "drive");
  EXPECT_EQ(json["scans"], 2);
  EXPECT_EQ(json["decode_ms"]["mean"], 2.0);
  EXPECT_EQ(json["default"]["ground"]["max"], 7.0);
  EXPECT_EQ(json["default"]["status"]["tracking"], 1);
  EXPECT_TRUE(json["default"]["t_percent"].is_null());
  EXPECT_TRUE(json["paper"]["stages_ms"]["align"]["p99"].is_number());
  const std::string text = to_text(run);
  EXPECT_NE(text.find("drive: 2 scans of 16 beams"), std::string::npos);
  EXPECT_EQ(text.find("deg/100 m"), std::string::npos);
}

}  // namespace
}  // namespace lilo
