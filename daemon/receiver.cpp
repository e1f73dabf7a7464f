// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/receiver.hpp"

#include "daemon/clock.hpp"
#include "drivers/sensor_table.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace lilo {
namespace {

constexpr std::chrono::milliseconds kReadTimeout{100};
constexpr std::int64_t kLongestQueueNs = 1'000'000'000;

void add(std::atomic<std::uint64_t>& counter) {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

// When a packet reached this computer, on the monotonic clock: the kernel's stamp is UTC, so its
// age is taken off now. A step of UTC in between may only bend one age, and within bounds.
std::int64_t arrival_ns(const PacketView& packet) {
  const std::int64_t age = realtime_ns() - packet.received_ns;
  return monotonic_ns() - (age > 0 && age < kLongestQueueNs ? age : 0);
}

// Profile default looks at features alone.
bool needs_returns(const OdometryConfig& config) { return config.profile == Profile::paper; }

const SensorTable& table_of(SensorModel model) {
  const SensorTable* known = find_sensor(model);
  return known != nullptr ? *known : *find_sensor(SensorModel::vlp16);
}

}  // namespace

Receiver::Receiver(std::unique_ptr<PacketSource> source, const SensorConfig& sensor,
                   const OdometryConfig& odometry, ScanRing& scans, Wakeup& scan_ready,
                   PipelineCounters& counters, PacketRing* packets)
    : source_(std::move(source)),
      scans_(scans),
      scan_ready_(scan_ready),
      counters_(counters),
      packets_(packets),
      needs_returns_(needs_returns(odometry)),
      extractor_(odometry),
      builder_(sensor, scan_, *this) {
  prepare_scan(scan_, sensor.model);
}

void Receiver::share_state() {
  const SensorStatus status = builder_.status();
  state_.store({builder_.counts(), source_->counts(), status});
  share_calibration(status);
}

void Receiver::share_calibration(const SensorStatus& status) {
  const Calibration* const calibration = builder_.calibration();
  if (status.calibration != CalibrationOrigin::packets || calibration == nullptr) return;
  const CalibrationTable table(*calibration);
  if (table == last_calibration_) return;
  last_calibration_ = table;
  calibration_.store(last_calibration_);
  calibrations_read_.store(calibrations_read_.load() + 1);
}

void Receiver::run() {
  // Without scans (no calibration yet, a stopped motor) the state is shared all the same.
  constexpr std::uint32_t kShareEvery = 512;
  std::uint32_t packets = 0;
  PacketView packet;
  while (!counters_.stop.load(std::memory_order_relaxed)) {
    const ReadResult result = source_->read(packet, kReadTimeout);
    if (result == ReadResult::packet) {
      last_packet_ns_.store(arrival_ns(packet), std::memory_order_relaxed);
      copy(packet);
      builder_.feed(packet);
      follow_scan();
      if (++packets % kShareEvery == 0) share_state();
    } else {
      share_state();
      if (result == ReadResult::end) return;
    }
  }
}

// For clients that record: no wait, no system call. What they miss they see by the number.
void Receiver::copy(const PacketView& packet) {
  if (packet.payload.size() > kMostPacketBytes) return;
  const std::uint64_t seq = packets_read_++;
  if (packets_ == nullptr || !counters_.packets_asked.load(std::memory_order_relaxed)) return;
  PacketDatagram* const slot = packets_->reserve();
  if (slot == nullptr) {
    add(counters_.packets_dropped);
    return;
  }
  write_packet(seq, packet, *slot);
  packets_->commit();
}

void Receiver::follow_scan() {
  const std::int64_t start_ns = monotonic_ns();
  extractor_.follow(scan_);
  extraction_ns_ += monotonic_ns() - start_ns;
}

Scan& Receiver::exchange(Scan& finished) {
  const std::int64_t now_ns = monotonic_ns();
  last_scan_ns_.store(now_ns, std::memory_order_relaxed);
  add(counters_.scans_received);
  if (ScanSlot* const slot = scans_.reserve(); slot != nullptr) {
    extractor_.finish(finished, slot->features);
    slot->extraction_ns = extraction_ns_ + monotonic_ns() - now_ns;
    hand_on(finished, *slot);
    scans_.commit();
    if (scans_.size() > counters_.ring_high_water) counters_.ring_high_water = scans_.size();
    scan_ready_.signal();
  } else {
    extractor_.give_up();
    add(counters_.scans_overrun);
  }
  if (scans_.reserve() == nullptr) counters_.behind.store(true, std::memory_order_release);
  share_state();
  finished.clear();
  extraction_ns_ = 0;
  return finished;
}

void Receiver::hand_on(Scan& finished, ScanSlot& slot) {
  slot.last_packet_ns = last_packet_ns_.load(std::memory_order_relaxed);
  most_returns_ = std::max(most_returns_, finished.returns.size());
  if (needs_returns_) {
    std::swap(finished, slot.scan);
    // What the largest scan so far needed: one that has to grow by itself would double.
    finished.returns.clear();
    if (finished.returns.capacity() < most_returns_)
      finished.returns.reserve(most_returns_ + most_returns_ / 32);
    return;
  }
  Returns returns = std::move(finished.returns);
  slot.scan = finished;
  finished.returns = std::move(returns);
}

void prepare_scan(Scan& scan, SensorModel model) {
  // One return a firing at 10 Hz, and a fifth more. What an unknown model, dual returns or a slower
  // head need more, the scan takes in its first turn and keeps.
  constexpr double kTurnNs = 120e6;
  const SensorTable& sensor = table_of(model);
  const double cycles = kTurnNs / sensor.times.front().cycle_ns;
  // With a value: a resize() alone leaves Returns untouched.
  scan.returns.assign(static_cast<std::size_t>(cycles * sensor.lasers), Return{});
  scan.clear();
}

void prepare_slot(ScanSlot& slot, SensorModel model, const OdometryConfig& odometry) {
  if (needs_returns(odometry)) prepare_scan(slot.scan, model);
  slot.features.all.resize(most_features(odometry, table_of(model).lasers));
  slot.features.all.clear();
}

}  // namespace lilo
