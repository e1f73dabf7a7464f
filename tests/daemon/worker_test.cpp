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
    const auto packets = static_cast<std::uint64_t>(RoundRoomSource::kPacketsPerTurn * 7.5);
    Receiver(std::make_unique<RoundRoomSource>(packets), {.model = SensorModel::vlp16}, {}, scans_,
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
  Worker worker_{{}, scans_, scan_ready_, reports_, report_ready_, counters_};
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

}  // namespace
}  // namespace lilo
