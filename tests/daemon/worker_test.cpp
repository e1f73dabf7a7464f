// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/worker.hpp"

#include "daemon/receiver.hpp"
#include "tests/daemon/vlp16_packets.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace lilo {
namespace {

/// A ring that five scans wait in, and a worker.
class WorkerTest : public testing::Test {
 protected:
  WorkerTest() {
    const auto packets = static_cast<std::uint64_t>(RoomSource::kPacketsPerTurn * 7.5);
    Receiver(std::make_unique<RoomSource>(packets), {.model = SensorModel::vlp16}, {}, scans_,
             scan_ready_, counters_)
        .run();
    counters_.behind = false;
    waiting_ = scans_.size();
    first_ = scans_.front()->scan.index;
  }

  /// Runs the worker until it has taken all scans.
  void run_worker() {
    std::thread thread([this] { worker_.run(); });
    while (scans_.size() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    counters_.stop = true;
    scan_ready_.signal();
    thread.join();
  }

  std::vector<PoseReport> reports() {
    std::vector<PoseReport> out;
    while (const PoseReport* report = reports_.front()) {
      out.push_back(*report);
      reports_.release();
    }
    return out;
  }

  ScanRing scans_{5};
  ReportRing reports_{4};
  Wakeup scan_ready_{Wakeup::Mode::blocking}, report_ready_{Wakeup::Mode::polled};
  PipelineCounters counters_;
  PointsRing points_{2};
  Worker worker_{{},       {}, scans_, scan_ready_, reports_, {points_, 50, 40}, report_ready_,
                 counters_};
  std::size_t waiting_ = 0;
  std::uint64_t first_ = 0;
};

TEST_F(WorkerTest, ReportsEveryScanInOrder) {
  scans_.release();  // four fit into the ring of reports
  run_worker();
  const auto all = reports();
  ASSERT_EQ(all.size(), 4U);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].seq, k);
    EXPECT_EQ(all[k].estimate.scan_index, first_ + 1 + k);
    EXPECT_GT(all[k].processing_ns, 0);
    EXPECT_TRUE(all[k].scan_complete);
  }
  EXPECT_EQ(counters_.scans_processed, 4U);
  EXPECT_EQ(counters_.scans_skipped, 0U);
  EXPECT_EQ(counters_.reports_dropped, 0U);
}

// Asked to catch up, it finishes the scan at hand and goes on with the newest.
TEST_F(WorkerTest, SkipsToTheNewestWhenBehind) {
  counters_.behind = true;
  run_worker();
  const auto all = reports();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].estimate.scan_index, first_);
  EXPECT_EQ(all[1].estimate.scan_index, first_ + waiting_ - 1);
  EXPECT_EQ(counters_.scans_skipped, waiting_ - 2);
  EXPECT_FALSE(counters_.behind);
}

// The publisher sleeps: poses are dropped and counted, the odometry goes on, seq shows the gap.
TEST_F(WorkerTest, NeverWaitsForThePublisher) {
  ASSERT_EQ(waiting_, 5U);
  run_worker();
  EXPECT_EQ(counters_.scans_processed, 5U);
  EXPECT_EQ(counters_.reports_dropped, 1U);
  EXPECT_EQ(reports().back().seq, 3U);
}

// Nothing is computed until a client asks. Of what then finds no room the worker takes no notice.
TEST_F(WorkerTest, GivesPointsWhileTheyAreAskedFor) {
  counters_.points_asked = true;
  run_worker();
  EXPECT_EQ(counters_.scans_processed, 5U);
  ASSERT_EQ(points_.size(), 2U) << "the ring's slots";
  for (std::uint64_t seq = 0; seq < 2; ++seq) {
    const PointsReport* seen = points_.front();
    EXPECT_EQ(seen->seq, seq);
    EXPECT_EQ(seen->scan_m.size(), 50U);
    for (const Eigen::Vector3f& p_m : seen->scan_m)
      EXPECT_NEAR(p_m.norm(), 10.0F, 0.1F) << "the room's wall";
    points_.release();
  }
}

TEST_F(WorkerTest, GivesNoPointsUnasked) {
  run_worker();
  EXPECT_EQ(counters_.scans_processed, 5U);
  EXPECT_EQ(points_.size(), 0U);
}

// The map is begun anew; the sensor is the same.
TEST_F(WorkerTest, KeepsTheErrorsOfTheBeamsThroughAReset) {
  BeamEstimate kept;
  kept.ring_count = 16;
  kept.elevation_rad[4] = 1e-3;
  kept.elevation_sigma_rad.fill(1e-4);
  Worker worker({}, kept, scans_, scan_ready_, reports_, {points_, 50, 40}, report_ready_,
                counters_);
  counters_.resets_asked = 1;
  std::thread thread([&] { worker.run(); });
  while (scans_.size() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  counters_.stop = true;
  scan_ready_.signal();
  thread.join();
  EXPECT_EQ(counters_.resets_done, 1U);
  BeamEstimate beams;
  ASSERT_TRUE(worker.beams().load(beams));
  EXPECT_NEAR(beams.elevation_rad[4], 1e-3, 2e-4) << "but for what it learnt since";
}

/// Both threads at once, as fast as they go. Slots: of the ring between them.
class ReceiverAndWorker : public testing::TestWithParam<std::size_t> {};

// Whatever was dropped on the way, the poses are those that one thread makes of the same scans.
TEST_P(ReceiverAndWorker, MakeThePosesOfOneThread) {
  constexpr auto kPackets = static_cast<std::uint64_t>(RoomSource::kPacketsPerTurn * 20.5);
  const SensorConfig sensor{.model = SensorModel::vlp16};
  Wakeup scan_ready(Wakeup::Mode::blocking), report_ready(Wakeup::Mode::polled);

  PipelineCounters counters;
  ScanRing scans(GetParam());
  ReportRing reports(32);
  Receiver receiver(std::make_unique<RoomSource>(kPackets), sensor, {}, scans, scan_ready,
                    counters);
  PointsRing points(4);
  Worker worker({}, {}, scans, scan_ready, reports, {points, 0, 0}, report_ready, counters);
  std::thread working([&] { worker.run(); });
  std::thread receiving([&] { receiver.run(); });
  receiving.join();
  while (scans.size() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  counters.stop = true;
  scan_ready.signal();
  working.join();
  EXPECT_EQ(counters.scans_processed + counters.scans_skipped + counters.scans_overrun,
            counters.scans_received);

  PipelineCounters all_counters;
  ScanRing all(32);
  Receiver(std::make_unique<RoomSource>(kPackets), sensor, {}, all, scan_ready, all_counters).run();
  Odometry odometry{OdometryConfig{}};
  std::size_t poses = 0;
  for (const PoseReport* report = reports.front(); report != nullptr; report = reports.front()) {
    const Estimate& found = report->estimate;
    while (all.front()->scan.index != found.scan_index) all.release();
    const Estimate expected = odometry.align(all.front()->scan, all.front()->features);
    odometry.update_map(all.front()->features);
    EXPECT_EQ(found.T_odom_sensor.translation_m, expected.T_odom_sensor.translation_m);
    EXPECT_EQ(found.T_odom_sensor.rotation.coeffs(), expected.T_odom_sensor.rotation.coeffs());
    EXPECT_EQ(found.twist.linear_mps, expected.twist.linear_mps);
    EXPECT_EQ(found.residual_rms_sigma, expected.residual_rms_sigma);
    ++poses;
    reports.release();
  }
  EXPECT_EQ(poses, counters.scans_processed);
  EXPECT_GE(poses, 2U);
}

INSTANTIATE_TEST_SUITE_P(Slots, ReceiverAndWorker, testing::Values(2, 4, 32));

}  // namespace
}  // namespace lilo
