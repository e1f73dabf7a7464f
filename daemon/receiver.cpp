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

}  // namespace

Receiver::Receiver(std::unique_ptr<PacketSource> source, const SensorConfig& sensor,
                   const OdometryConfig& odometry, ScanRing& scans, Wakeup& scan_ready,
                   PipelineCounters& counters, PacketRing* packets)
    : source_(std::move(source)),
      scans_(scans),
      scan_ready_(scan_ready),
      counters_(counters),
      packets_(packets),
      writing_(scans.reserve()),
      extractor_(odometry),
      builder_(sensor, writing_->scan, *this) {
  prepare_slot(spare_, sensor.model, odometry);
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
  extractor_.follow(writing_->scan);
  writing_->extraction_ns += monotonic_ns() - start_ns;
}

// The scan just written goes to the worker, and the next free slot is written. With all slots
// taken, the spare one is written instead and the worker told; should it still be at work when the
// spare is full too, that scan is given up.
Scan& Receiver::exchange(Scan& finished) {
  const std::int64_t start_ns = monotonic_ns();
  extractor_.finish(finished, writing_->features);
  writing_->extraction_ns += monotonic_ns() - start_ns;
  most_returns_ = std::max(most_returns_, finished.returns.size());
  add(counters_.scans_received);
  last_scan_ns_.store(start_ns, std::memory_order_relaxed);
  writing_->last_packet_ns = last_packet_ns_.load(std::memory_order_relaxed);
  ScanSlot* slot = writing_;
  if (writing_ == &spare_) {
    slot = scans_.reserve();
    if (slot != nullptr) std::swap(*slot, spare_);
  }
  if (slot != nullptr) {
    scans_.commit();
    if (scans_.size() > counters_.ring_high_water) counters_.ring_high_water = scans_.size();
    scan_ready_.signal();
  } else {
    add(counters_.scans_overrun);
  }
  share_state();
  writing_ = scans_.reserve();
  if (writing_ == nullptr) {
    counters_.behind.store(true, std::memory_order_release);
    writing_ = &spare_;
  }
  writing_->scan.clear();
  writing_->extraction_ns = 0;
  // What the largest scan so far needed: one that has to grow by itself would double.
  if (writing_->scan.returns.capacity() < most_returns_)
    writing_->scan.returns.reserve(most_returns_ + most_returns_ / 32);
  return writing_->scan;
}

void prepare_slot(ScanSlot& slot, SensorModel model, const OdometryConfig& odometry) {
  // One return a firing at 10 Hz, and a tenth more. What an unknown model, dual returns or a slower
  // head need more, the slots take in their first turn and keep.
  constexpr double kTurnNs = 110e6;
  const SensorTable* known = find_sensor(model);
  const SensorTable& sensor = known != nullptr ? *known : *find_sensor(SensorModel::vlp16);
  const double cycles = kTurnNs / sensor.times.front().cycle_ns;
  // With a value: a resize() alone leaves Returns untouched.
  slot.scan.returns.assign(static_cast<std::size_t>(cycles * sensor.lasers), Return{});
  slot.scan.clear();
  slot.features.all.resize(most_features(odometry, sensor.lasers));
  slot.features.all.clear();
}

}  // namespace lilo
