// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/run_report.hpp"

#include "tests/core/analytic_scene.hpp"
#include "tools/run/statistics.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <numeric>

namespace lilo {
namespace {

TEST(Statistics, PercentilesAreNearestRank) {
  std::vector<double> values(200);
  std::iota(values.rbegin(), values.rend(), 1.0);  // 200 ... 1
  const Statistics s = statistics(values);
  EXPECT_EQ(s.mean, 100.5);
  EXPECT_EQ(s.p50, 100.0);
  EXPECT_EQ(s.p99, 198.0);
  EXPECT_EQ(s.max, 200.0);
  EXPECT_EQ(statistics({7.0}).p50, 7.0);
  EXPECT_EQ(statistics({}).max, 0.0);
}

TEST(Statistics, TenthsAreEqualParts) {
  std::vector<double> values(205);
  std::iota(values.begin(), values.end(), 0.0);
  const auto means = means_of_tenths(values);
  EXPECT_EQ(means[0], 9.5);    // 0 to 19
  EXPECT_EQ(means[1], 30.0);   // 20 to 40
  EXPECT_EQ(means[9], 194.0);  // 184 to 204
  EXPECT_EQ(means_of_tenths({1.0, 2.0})[0], 0.0);
}

/// A few scans, then the file breaks off.
class BrokenSource : public ScanSource {
 public:
  explicit BrokenSource(std::uint64_t scans = 2) : scans_(scans) {}
  bool next(Scan& scan) override {
    if (made_ == scans_) return false;
    scan.clear();
    scan.index = made_++;
    scan.start_ns = static_cast<std::int64_t>(made_) * 100'000'000;
    scan.end_ns = scan.start_ns + 99'000'000;
    scan.complete = true;
    scan.beams.ring_count = 16;
    return true;
  }
  [[nodiscard]] DriverCounts driver_counts() const override { return {.data_packets = 150}; }
  [[nodiscard]] SourceCounts source_counts() const override { return {}; }
  [[nodiscard]] double progress() const override { return 0.0; }
  [[nodiscard]] std::string error() const override { return "made.pcap: ends inside a record"; }

 private:
  std::uint64_t scans_, made_ = 0;
};

/// A scan of a sensor nose down by 10 degrees.
class TiltedSource : public BrokenSource {
 public:
  TiltedSource() : BrokenSource(1) {}
  bool next(Scan& scan) override {
    if (!BrokenSource::next(scan)) return false;
    scan = test::still_scan_of(test::yard(), test::even_beams(16, -15.0, 15.0),
                               {so3_exp({0.0, 0.1745, 0.0}), Eigen::Vector3d::Zero()});
    return true;
  }
};

TEST(OdometryRun, KeepsWhatWasDoneBeforeTheSourceFailed) {
  BrokenSource source;
  int seen = 0;
  const OdometryRun run = run_odometry(source, {}, [&](const Scan&, const Estimate&) { ++seen; });
  EXPECT_EQ(seen, 2);
  EXPECT_EQ(run.poses.size(), 2U);
  EXPECT_EQ(run.poses[1].stamp_ns, 299'000'000);
  EXPECT_EQ(run.failure, "made.pcap: ends inside a record");
  EXPECT_NEAR(run.recorded_s, 0.199, 1e-12);
}

TEST(RunReport, JsonHasTheDocumentedKeys) {
  BrokenSource source;
  const OdometryRun run = run_odometry(source, {}, [](const Scan&, const Estimate&) {});
  const auto json = nlohmann::json::parse(to_json(run));
  EXPECT_EQ(json["scans"], 2);
  EXPECT_EQ(json["packets"], 150);
  EXPECT_EQ(json["packets_lost"], 0);
  EXPECT_EQ(json["cpu_ms_per_scan"], json["total_ms"]["mean"]);
  for (const char* figure : {"mean", "p50", "p99", "max"}) {
    EXPECT_TRUE(json["total_ms"][figure].is_number());
    EXPECT_TRUE(json["stages_ms"]["decode"][figure].is_number());
  }
  EXPECT_GT(json["peak_rss_mb"].get<double>(), 1.0);
}

TEST(RunReport, SaysByHowMuchScansWereLevelled) {
  BrokenSource level;
  TiltedSource tilted;
  const auto ignore = [](const Scan&, const Estimate&) {};
  const OdometryRun of_level = run_odometry(level, {}, ignore);
  const OdometryRun of_tilted = run_odometry(tilted, {}, ignore);
  EXPECT_EQ(nlohmann::json::parse(to_json(of_level))["tilt_deg"], 0.0);
  EXPECT_EQ(to_text(of_level).find("against the ground"), std::string::npos);
  EXPECT_NEAR(nlohmann::json::parse(to_json(of_tilted))["tilt_deg"].get<double>(), 10.0, 0.2);
  EXPECT_NE(to_text(of_tilted).find("deg against the ground"), std::string::npos);
}

TEST(RunReport, SaysWhatGrowsFromTenthToTenth) {
  BrokenSource source(40);
  const OdometryRun run = run_odometry(source, {}, [](const Scan&, const Estimate&) {});
  const auto tenths = nlohmann::json::parse(to_json(run))["tenths"];
  for (const char* key :
       {"cpu_ms_per_scan", "map_size", "correspondences", "iterations", "rss_mb"}) {
    EXPECT_EQ(tenths[key].size(), 10U) << key;
  }
  EXPECT_GT(tenths["rss_mb"][9].get<double>(), 1.0);
  EXPECT_LE(tenths["rss_mb"][9].get<double>(), run.peak_rss_mb + 1e-6);
  double sum = 0.0;
  for (const double mean : tenths["cpu_ms_per_scan"]) sum += mean / 10.0;
  EXPECT_NEAR(sum, statistics(run.timer.total_ms()).mean, 1e-9);
}

TEST(RunReport, StagesAddUpToTheTotal) {
  BrokenSource source;
  const OdometryRun run = run_odometry(source, {}, [](const Scan&, const Estimate&) {});
  for (std::size_t k = 0; k < run.poses.size(); ++k) {
    double sum = run.timer.decode_ms()[k];
    for (int s = 0; s < kStageCount; ++s) sum += run.timer.stage_ms(static_cast<Stage>(s))[k];
    EXPECT_LE(sum, run.timer.total_ms()[k] + 1e-9);
  }
}

}  // namespace
}  // namespace lilo
