// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/engine.hpp"
#include "daemon/health_monitor.hpp"
#include "daemon/points_message.hpp"
#include "daemon/pose_message.hpp"
#include "daemon/publisher.hpp"
#include "daemon/receiver.hpp"
#include "daemon/request.hpp"
#include "daemon/sinks.hpp"
#include "tests/daemon/vlp16_packets.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <thread>
#include <unistd.h>

/// Every allocation of this program is counted, on whatever thread.
namespace {
std::atomic<std::uint64_t> allocations{0};
thread_local std::uint64_t allocations_of_this_thread = 0;
}  // namespace

// Inlined, GCC would take the pair of them for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  ++allocations_of_this_thread;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace lilo {
namespace {

TEST(Allocation, IsCounted) {
  const std::uint64_t before = allocations;
  const std::vector<int> v(100);
  EXPECT_GT(allocations, before);
  EXPECT_EQ(v.size(), 100U);
}

/// A sensor whose scans are taken as soon as they are there; notes the count at the given packet.
class TakenSource : public PacketSource {
 public:
  TakenSource(std::uint64_t packets, std::uint64_t warm_at, ScanRing& scans, PacketRing& copies)
      : source_(packets), warm_at_(warm_at), scans_(scans), copies_(copies) {}
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override {
    while (scans_.front() != nullptr) scans_.release();
    while (copies_.front() != nullptr) copies_.release();
    if (++read_ == warm_at_) allocations_when_warm = allocations;
    return source_.read(packet, timeout);
  }
  [[nodiscard]] SourceCounts counts() const override { return source_.counts(); }

  std::uint64_t allocations_when_warm = 0;

 private:
  RoomSource source_;
  std::uint64_t warm_at_, read_ = 0;
  ScanRing& scans_;
  PacketRing& copies_;
};

// Packets to scans in the ring, and to those who record: nothing after every slot has been written
// once.
TEST(Allocation, ReceiverHasNoneOnceWarm) {
  ScanRing scans(4);
  scans.for_each_slot([](ScanSlot& slot) { prepare_slot(slot, SensorModel::vlp16, {}); });
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  counters.packets_asked = true;
  PacketRing copies(8);
  auto owned = std::make_unique<TakenSource>(4000, 800, scans, copies);
  const TakenSource& source = *owned;
  Receiver receiver(std::move(owned), {.model = SensorModel::vlp16}, {}, scans, ready, counters,
                    &copies);
  receiver.run();
  EXPECT_GT(counters.scans_received, 45U);
  EXPECT_EQ(counters.packets_dropped, 0U);
  EXPECT_EQ(allocations - source.allocations_when_warm, 0U);
}

TEST(Allocation, ANewSessionHasNone) {
  std::string session = new_session();
  const std::string old = session;
  const std::uint64_t before = allocations;
  renew_session(session);
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_NE(session, old);
  EXPECT_EQ(session.size(), 16U);
}

// A pose to two sinks, covariance and all.
TEST(Allocation, PublishingAPoseHasNone) {
  boost::asio::io_context io;
  Sinks sinks(io);
  sinks.set({"127.0.0.1:9", "127.0.0.1:10"});
  const PoseMessageContext context{"0123456789abcdef", "odom", "velodyne"};
  PoseReport report;
  report.estimate.status = TrackingStatus::tracking;
  report.estimate.has_covariance = true;
  JsonWriter json;
  const std::uint64_t before = allocations;
  for (int k = 0; k < 100; ++k) {
    report.estimate.T_odom_sensor.translation_m.x() = 0.1 * k;
    sinks.send(write_pose(context, report, 1'000'000, json));
  }
  EXPECT_EQ(allocations - before, 0U);
}

// What was seen with a pose, in all its datagrams.
TEST(Allocation, WritingPointsHasNone) {
  const std::vector<Eigen::Vector3f> points_m(600, Eigen::Vector3f(1.0F, -2.0F, 3.0F));
  const PointsContext context{"0123456789abcdef", 1'000'000'000, 17};
  JsonWriter json;
  std::size_t bytes = 0;
  const std::uint64_t before = allocations;
  for (std::size_t k = 0; k < points_datagrams(points_m.size()); ++k)
    bytes += write_points(context, PointSet::scan, points_m, k, json).size();
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_GT(bytes, 600U * 8U);
}

// Subscribers renew while poses are sent. The token has 16 digits: more than a short string holds.
TEST(Allocation, ReadingARenewedSubscriptionHasOneForItsToken) {
  const std::string renewed = R"({"subscribe":{"ttl_s":5,"points":true,"packets":false}})";
  const std::string by_token =
      R"({"token":"0123456789abcdef","subscribe":{"ttl_s":5,"points":true}})";
  std::uint64_t before = allocations;
  EXPECT_TRUE(parse_request(renewed).request->wants.points);
  EXPECT_EQ(allocations - before, 0U);
  before = allocations;
  EXPECT_EQ(parse_request(by_token).request->token, "0123456789abcdef");
  EXPECT_LE(allocations - before, 1U);
}

/// A sensor as fast as its packets are taken, but for a breath between two.
class SteadySource : public PacketSource {
 public:
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override {
    std::this_thread::sleep_for(std::chrono::microseconds(20));
    return source_.read(packet, timeout);
  }
  [[nodiscard]] SourceCounts counts() const override { return source_.counts(); }

 private:
  RoomSource source_{1'000'000};
};

// What the publisher does by itself: poses in the robot's frame, health, metrics, the record.
TEST(Allocation, PublisherHasNoneOnceWarm) {
  const std::string metrics = testing::TempDir() + "lilo_allocation_" + std::to_string(getpid());
  Config config;
  config.sensor.model = SensorModel::vlp16;
  config.subscribe.port = 0;
  config.publish.sinks = {"127.0.0.1:9", "127.0.0.1:10"};
  config.publish.T_base_sensor.x_m = 1.5;
  config.health.metrics_file = metrics;
  boost::asio::io_context io;
  Engine engine(config, std::make_unique<SteadySource>());
  HealthMonitor monitor(engine);
  Story story;
  Publisher publisher(io, config, engine, monitor, story);
  RealtimeReport realtime = engine.start();
  realtime.refusals.emplace_back("a refusal that is longer than a short string holds");
  monitor.started(realtime);
  const auto publish_until = [&](std::uint64_t poses) {
    while (publisher.last_health().poses_sent < poses) {
      publisher.take_reports();
      publisher.tick();
    }
  };
  publish_until(10);
  const std::uint64_t before = allocations_of_this_thread;
  publish_until(40);
  EXPECT_EQ(allocations_of_this_thread - before, 0U);
  EXPECT_GT(std::filesystem::file_size(metrics), 1000U);
  EXPECT_EQ(publisher.last_health().poses_not_sent, 0U);
  engine.stop();
  std::filesystem::remove(metrics);
}

}  // namespace
}  // namespace lilo
