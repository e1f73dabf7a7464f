// SPDX-License-Identifier: BSD-3-Clause
// The real VLP-16 capture: 293 data and 57 position packets in 0.388 s at 600 rpm, nothing lost,
// the azimuth wraps four times, GPS locked on 21 January 2016, 08:18:02 UTC (facts read from the
// bytes by independent programs).
#include "drivers/gprmc.hpp"
#include "drivers/scan_source.hpp"
#include "tests/drivers/data_dir.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lilo {
namespace {

const char* const kCapture = "real/vlp16_single_gps.pcap";

struct Recording {
  std::vector<Scan> scans;
  DriverCounts driver;
  SourceCounts source;
};

Recording read_all(const SensorConfig& config = {}) {
  auto source = open_scans(test::data_path(kCapture), config);
  Recording recording;
  Scan scan;
  while (source->next(scan)) recording.scans.push_back(scan);
  recording.driver = source->driver_counts();
  recording.source = source->source_counts();
  EXPECT_EQ(source->error(), "");
  return recording;
}

TEST(RealVlp16Capture, HoldsThePacketsItsReadmeStates) {
  LILO_NEED_DATA(kCapture);
  const Recording r = read_all();
  EXPECT_EQ(r.driver.data_packets, 293U);
  EXPECT_EQ(r.driver.position_packets, 57U);
  EXPECT_EQ(r.driver.packets_lost, 0U);
  EXPECT_EQ(r.driver.packets_duplicated, 0U);
  EXPECT_EQ(r.driver.packets_reordered, 0U);
  EXPECT_EQ(r.driver.malformed_packets, 0U);
  EXPECT_EQ(r.driver.sensor_restarts, 0U);
  EXPECT_EQ(r.source.packets, 350U);
}

TEST(RealVlp16Capture, FourWrapsBoundThreeWholeRevolutions) {
  LILO_NEED_DATA(kCapture);
  const Recording r = read_all();
  ASSERT_EQ(r.scans.size(), 3U);
  for (const Scan& scan : r.scans) {
    EXPECT_TRUE(scan.complete);
    EXPECT_EQ(scan.hole_width_rad, 0.0F);
    EXPECT_EQ(scan.packets.lost, 0U);
    EXPECT_NEAR(static_cast<double>(scan.end_ns - scan.start_ns), 1e8, 1e6);  // 600 rpm
    EXPECT_NEAR(scan.packets.received, 75.4, 1.0);  // 754 packets a second
  }
}

TEST(RealVlp16Capture, TimeIsThatOfTheGpsSentences) {
  LILO_NEED_DATA(kCapture);
  const Recording r = read_all();
  const std::int64_t sentence_ns = utc_seconds(2016, 1, 21, 8, 18, 2) * 1'000'000'000;
  for (const Scan& scan : r.scans) {
    EXPECT_EQ(scan.clock, ClockSource::gps);
    EXPECT_GT(scan.start_ns, sentence_ns);
    EXPECT_LT(scan.end_ns, sentence_ns + 1'000'000'000);
  }
  // The first packet's stamp is 1082.340595 s past the hour and the first cut comes 0.0669 s later.
  EXPECT_NEAR(static_cast<double>(r.scans[0].start_ns - sentence_ns) * 1e-9, 0.3406 + 0.067, 0.002);
}

TEST(RealVlp16Capture, TimesRiseAndScansFollowEachOther) {
  LILO_NEED_DATA(kCapture);
  const Recording r = read_all();
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    const Scan& scan = r.scans[i];
    for (std::size_t k = 1; k < scan.returns.size(); ++k)
      ASSERT_GE(scan.returns[k].t_ns, scan.returns[k - 1].t_ns);
    EXPECT_LE(scan.returns.back().t_ns, scan.end_ns - scan.start_ns);
    if (i == 0) continue;
    // From a sequence's last laser to the next one's first: 55.296 - 15 * 2.304 us.
    EXPECT_NEAR(static_cast<double>(scan.start_ns - r.scans[i - 1].end_ns), 20736.0, 1000.0);
    EXPECT_EQ(scan.index, r.scans[i - 1].index + 1);
  }
}

TEST(RealVlp16Capture, AnyCutAzimuthGivesTheSameReturnsInOtherScans) {
  LILO_NEED_DATA(kCapture);
  SensorConfig config;
  config.cut_azimuth_rad = 1.0;
  const Recording r = read_all(config);
  ASSERT_GE(r.scans.size(), 2U);
  for (const Scan& scan : r.scans) {
    EXPECT_TRUE(scan.complete);
    // Clockwise one radian from +x is minus one, and the head turns clockwise.
    EXPECT_NEAR(scan.returns.front().azimuth_rad, -1.0, 0.02);
    EXPECT_NEAR(scan.returns.back().azimuth_rad, -1.0, 0.02);
  }
}

TEST(RealVlp16Capture, PointsLieWhereAzimuthAndRingSay) {
  LILO_NEED_DATA(kCapture);
  for (const Scan& scan : read_all().scans) {
    ASSERT_EQ(scan.beams.ring_count, 16);
    for (const Return& p : scan.returns) {
      ASSERT_LT(p.ring, 16);
      const auto x = static_cast<double>(p.x_m), y = static_cast<double>(p.y_m);
      const auto azimuth_rad = static_cast<double>(p.azimuth_rad);
      EXPECT_NEAR(std::remainder(std::atan2(y, x) - azimuth_rad, 2 * M_PI), 0.0, 1e-4);
      const auto w = static_cast<double>(scan.beams.elevation_rad[p.ring]);
      const double origin_m = 0.04191 * std::tan(-w);
      const double horizontal = std::hypot(x, y);
      EXPECT_NEAR(p.z_m, horizontal * std::tan(w) + origin_m, 1e-4 + 1e-6 * horizontal);
    }
  }
}

}  // namespace
}  // namespace lilo
