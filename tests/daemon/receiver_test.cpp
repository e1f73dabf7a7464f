// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/receiver.hpp"

#include "daemon/clock.hpp"
#include "tests/daemon/vlp16_packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace lilo {
namespace {

const SensorConfig kVlp16{.model = SensorModel::vlp16};

/// Packets for `turns` whole revolutions and a little.
std::unique_ptr<PacketSource> turns(int turns) {
  const double packets = RoomSource::kPacketsPerTurn * (turns + 0.5);
  return std::make_unique<RoomSource>(static_cast<std::uint64_t>(packets));
}

/// The scans of a source, with their returns, as profile paper asks for them.
std::map<std::uint64_t, Scan> whole_scans(std::unique_ptr<PacketSource> source) {
  ScanRing scans(32);
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  Receiver(std::move(source), kVlp16, {.profile = Profile::paper}, scans, ready, counters).run();
  std::map<std::uint64_t, Scan> whole;
  for (; const ScanSlot* slot = scans.front(); scans.release())
    whole[slot->scan.index] = slot->scan;
  return whole;
}

/// Those found while the scan was measured are those of the scan as a whole.
void expect_features_of(const Scan& scan, const ScanSlot& slot) {
  FeatureExtractor extractor{OdometryConfig{}};
  ScanFeatures whole;
  extractor.finish(scan, whole);
  EXPECT_GT(whole.all.size(), 10'000U);
  ASSERT_EQ(slot.features.all.size(), whole.all.size()) << "scan " << slot.scan.index;
  const auto same = [](const Feature& a, const Feature& b) {
    return a.x_m == b.x_m && a.y_m == b.y_m && a.z_m == b.z_m && a.s == b.s && a.kind == b.kind;
  };
  EXPECT_TRUE(std::equal(whole.all.begin(), whole.all.end(), slot.features.all.begin(), same))
      << "scan " << slot.scan.index;
}

TEST(Receiver, HandsOnEveryScanInOrder) {
  ScanRing scans(32);
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  const std::int64_t before = monotonic_ns();
  Receiver receiver(turns(12), kVlp16, {}, scans, ready, counters);
  receiver.run();
  ready.wait();
  // The first revolution starts at azimuth 0, which is the cut: it may or may not be counted whole.
  ASSERT_GE(scans.size(), 11U);
  EXPECT_EQ(counters.scans_received, scans.size());
  EXPECT_EQ(counters.scans_overrun, 0U);
  EXPECT_FALSE(counters.behind);
  std::uint64_t index = scans.front()->scan.index;
  std::int64_t end_ns = 0;
  const auto whole = whole_scans(turns(12));
  EXPECT_EQ(whole.size(), scans.size());
  while (const ScanSlot* slot = scans.front()) {
    EXPECT_EQ(slot->scan.index, index++);
    EXPECT_TRUE(slot->scan.complete);
    const Scan& scan = whole.at(slot->scan.index);
    EXPECT_NEAR(static_cast<double>(scan.returns.size()), 0.1e9 / 55296.0 * 16, 64);
    EXPECT_TRUE(slot->scan.returns.empty()) << "profile default has no use for them";
    EXPECT_GT(slot->scan.start_ns, end_ns);
    EXPECT_NEAR(static_cast<double>(slot->scan.end_ns - slot->scan.start_ns), 0.1e9, 0.2e6);
    EXPECT_GE(slot->last_packet_ns, before);
    EXPECT_LE(slot->last_packet_ns, monotonic_ns());
    expect_features_of(scan, *slot);
    end_ns = slot->scan.end_ns;
    scans.release();
  }
  ReceiverState state;
  ASSERT_TRUE(receiver.state().load(state));
  EXPECT_EQ(state.driver.packets_lost, 0U);
  EXPECT_GT(state.driver.data_packets, 0U);
  EXPECT_EQ(state.sensor.model, SensorModel::vlp16);
  EXPECT_NEAR(state.sensor.rpm, 600.0, 1.0);
  EXPECT_GE(receiver.last_scan_ns(), before);
}

// Nobody takes scans: the ring holds the oldest, the rest is counted, the worker is asked to skip.
TEST(Receiver, FullRingIsCountedAndToldToTheWorker) {
  ScanRing scans(3);
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  Receiver receiver(turns(12), kVlp16, {}, scans, ready, counters);
  receiver.run();
  EXPECT_EQ(scans.size(), 3U);
  EXPECT_TRUE(counters.behind);
  EXPECT_EQ(counters.scans_received, scans.size() + counters.scans_overrun);
}

/// The first packets of another source.
class FirstPackets : public PacketSource {
 public:
  FirstPackets(std::unique_ptr<PacketSource> source, int packets)
      : source_(std::move(source)), left_(packets) {}
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override {
    return left_-- > 0 ? source_->read(packet, timeout) : ReadResult::end;
  }
  [[nodiscard]] SourceCounts counts() const override { return source_->counts(); }

 private:
  std::unique_ptr<PacketSource> source_;
  int left_;
};

// The table takes 4160 packets; 2000 bring about half of it, and no scan.
TEST(Receiver, SaysHowMuchOfTheCalibrationItHas) {
  const std::string capture = std::string(LILO_DATA_DIR) + "/sim_hdl64_town/data.pcap";
  if (!std::filesystem::exists(capture)) GTEST_SKIP() << capture << " is not here";
  ScanRing scans(4);
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  Receiver receiver(std::make_unique<FirstPackets>(open_pcap(capture), 2000),
                    {.model = SensorModel::hdl64e}, {}, scans, ready, counters);
  receiver.run();
  EXPECT_EQ(scans.size(), 0U);
  EXPECT_EQ(receiver.last_scan_ns(), 0);
  ReceiverState state;
  ASSERT_TRUE(receiver.state().load(state));
  EXPECT_EQ(state.sensor.calibration, CalibrationOrigin::none);
  EXPECT_NEAR(state.sensor.calibration_progress, 2000.0 / 4160.0, 0.1);
}

/// A source that lets the test act as the worker in the middle of the stream.
class InterruptedSource : public PacketSource {
 public:
  InterruptedSource(std::unique_ptr<PacketSource> source, std::uint64_t at,
                    std::function<void()> act)
      : source_(std::move(source)), at_(at), act_(std::move(act)) {}
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override {
    if (read_++ == at_) act_();
    return source_->read(packet, timeout);
  }
  [[nodiscard]] SourceCounts counts() const override { return source_->counts(); }

 private:
  std::unique_ptr<PacketSource> source_;
  std::uint64_t at_, read_ = 0;
  std::function<void()> act_;
};

// The worker wakes up after 6.5 turns and empties the ring: the scan being written
// then gets in, whole, and the stream goes on without a gap.
TEST(Receiver, GoesOnWithTheNewestScan) {
  ScanRing scans(3);
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  std::vector<std::uint64_t> taken;
  const auto whole = whole_scans(turns(9));
  const auto take_all = [&] {
    while (const ScanSlot* slot = scans.front()) {
      taken.push_back(slot->scan.index);
      EXPECT_TRUE(slot->scan.complete);
      expect_features_of(whole.at(slot->scan.index),
                         *slot);  // of no scan that was given up half-way
      scans.release();
    }
  };
  const auto at = static_cast<std::uint64_t>(6.5 * RoomSource::kPacketsPerTurn);
  Receiver receiver(std::make_unique<InterruptedSource>(turns(9), at, take_all), kVlp16, {}, scans,
                    ready, counters);
  receiver.run();
  take_all();
  const std::uint64_t first = taken.at(0);
  ASSERT_GE(taken.size(), 6U);
  EXPECT_EQ(taken[2], first + 2) << "the ring was full from here";
  for (std::size_t k = 4; k < taken.size(); ++k) EXPECT_EQ(taken[k], taken[k - 1] + 1);
  EXPECT_EQ(taken[3] - taken[2] - 1, counters.scans_overrun) << "the gap is what was counted";
  EXPECT_GT(counters.scans_overrun, 0U);
}

/// A network in which some packets are overtaken, by up to eight others.
class OvertakingSource : public PacketSource {
 public:
  explicit OvertakingSource(std::unique_ptr<PacketSource> source) : source_(std::move(source)) {}
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override {
    if (held_until_ != 0 && held_until_ <= read_) {
      held_until_ = 0;
      packet = held_;
      packet.payload = bytes_;
      return ReadResult::packet;
    }
    const ReadResult result = source_->read(packet, timeout);
    if (++read_ % 13 != 0 || held_until_ != 0 || result != ReadResult::packet) return result;
    held_ = packet;
    bytes_.assign(packet.payload.begin(), packet.payload.end());
    held_until_ = read_ + 1 + read_ % 8;
    return read(packet, timeout);
  }
  [[nodiscard]] SourceCounts counts() const override { return source_->counts(); }

 private:
  std::unique_ptr<PacketSource> source_;
  PacketView held_;
  std::vector<std::byte> bytes_;
  std::uint64_t read_ = 0, held_until_ = 0;
};

TEST(Receiver, FindsTheFeaturesOfPacketsThatWereOvertaken) {
  ScanRing scans(32);
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  Receiver receiver(std::make_unique<OvertakingSource>(turns(12)), kVlp16, {}, scans, ready,
                    counters);
  receiver.run();
  ASSERT_GE(scans.size(), 10U);
  std::uint32_t overtaken = 0;
  const auto whole = whole_scans(std::make_unique<OvertakingSource>(turns(12)));
  while (const ScanSlot* slot = scans.front()) {
    expect_features_of(whole.at(slot->scan.index), *slot);
    overtaken += slot->scan.packets.reordered;
    scans.release();
  }
  EXPECT_GT(overtaken, 30U);
}

// Every packet in order, then as many as there are slots; the others are counted.
TEST(Receiver, CopiesPacketsForThoseWhoRecord) {
  constexpr std::uint64_t kPackets = 100;
  for (const std::size_t slots : {std::size_t{128}, std::size_t{40}}) {
    ScanRing scans(4);
    PacketRing packets(slots);
    Wakeup ready(Wakeup::Mode::blocking);
    PipelineCounters counters;
    counters.packets_asked = true;
    Receiver(std::make_unique<RoomSource>(kPackets), kVlp16, {}, scans, ready, counters, &packets)
        .run();
    ASSERT_EQ(packets.size(), std::min<std::size_t>(slots, kPackets));
    EXPECT_EQ(counters.packets_dropped, kPackets - packets.size());
    RoomSource sent(kPackets);
    for (std::uint64_t seq = 0; const PacketDatagram* datagram = packets.front(); ++seq) {
      const auto message = read_packet(datagram->view());
      PacketView expected;
      sent.read(expected, {});
      ASSERT_TRUE(message);
      EXPECT_EQ(message->seq, seq);
      EXPECT_EQ(message->packet.received_ns, expected.received_ns);
      EXPECT_TRUE(std::ranges::equal(message->packet.payload, expected.payload));
      packets.release();
    }
  }
}

TEST(Receiver, CopiesNoPacketsUnlessAsked) {
  ScanRing scans(4);
  PacketRing packets(128);
  Wakeup ready(Wakeup::Mode::blocking);
  PipelineCounters counters;
  Receiver(std::make_unique<RoomSource>(100), kVlp16, {}, scans, ready, counters, &packets).run();
  EXPECT_EQ(packets.size(), 0U);
  EXPECT_EQ(counters.packets_dropped, 0U);
}

long minor_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt;
}

// Memory that is only reserved comes when it is first written: 820 page faults in the middle of the
// first scans.
TEST(PrepareScan, TouchesWhatAScanNeeds) {
  Scan scan;
  prepare_scan(scan, SensorModel::hdl64e);
  EXPECT_TRUE(scan.returns.empty());
  EXPECT_GE(scan.returns.capacity(), 133'333U);  // a turn at 10 Hz
  const long before = minor_faults();
  scan.returns.assign(scan.returns.capacity(), Return{});
  EXPECT_LT(minor_faults() - before, 20);
}

TEST(PrepareSlot, TouchesWhatFeaturesNeed) {
  ScanSlot slot;
  prepare_slot(slot, SensorModel::hdl64e, OdometryConfig{});
  auto& features = slot.features.all;
  EXPECT_TRUE(features.empty());
  EXPECT_GE(features.capacity(), 36'864U);  // 64 x 576
  EXPECT_EQ(slot.scan.returns.capacity(), 0U);
  const long before = minor_faults();
  features.assign(features.capacity(), Feature{});
  EXPECT_LT(minor_faults() - before, 20);
}

}  // namespace
}  // namespace lilo
