// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/worker.hpp"

#include "daemon/clock.hpp"

#include <numeric>
#include <sys/resource.h>

namespace lilo {
namespace {

void add(std::atomic<std::uint64_t>& counter) {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

// Of the calling thread.
std::uint64_t minor_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt);
}

}  // namespace

StageHook StageTimer::hook() {
  const auto done = [](void* context, Stage stage) {
    auto& timer = *static_cast<StageTimer*>(context);
    const std::int64_t now_ns = monotonic_ns();
    timer.stage_ns[static_cast<std::size_t>(stage)] += now_ns - timer.last_ns;
    timer.last_ns = now_ns;
  };
  return {done, this};
}

Worker::Worker(const OdometryConfig& config, const BeamEstimate& kept, ScanRing& scans,
               Wakeup& scan_ready, ReportRing& reports, PointsOutput points, Wakeup& report_ready,
               PipelineCounters& counters)
    : config_(config),
      odometry_(config),
      scans_(scans),
      scan_ready_(scan_ready),
      reports_(reports),
      points_(points),
      report_ready_(report_ready),
      counters_(counters) {
  odometry_->resume_beams(kept);
}

void Worker::run() {
  while (!counters_.stop.load(std::memory_order_relaxed)) {
    const std::uint64_t maps_asked = counters_.maps_asked.load(std::memory_order_acquire);
    if (maps_asked != counters_.maps_done.load(std::memory_order_relaxed)) copy_map(maps_asked);
    ScanSlot* slot = scans_.front();
    if (slot == nullptr) {
      scan_ready_.wait();
      continue;
    }
    const std::uint64_t resets = counters_.resets_asked.load(std::memory_order_acquire);
    if (resets != resets_) begin_again(resets);
    align(*slot);
    update_map(*slot);
    if (counters_.points_asked.load(std::memory_order_relaxed)) report_points(*slot);
    scans_.release();
    if (counters_.behind.exchange(false, std::memory_order_acquire)) skip_to_newest();
  }
}

void Worker::copy_map(std::uint64_t asked) {
  map_copy_ = {.points_m = odometry_->map_points(), .resets = resets_};
  counters_.maps_done.store(asked, std::memory_order_release);
  report_ready_.signal();
}

void Worker::begin_again(std::uint64_t resets) {
  const BeamEstimate beams = odometry_->beam_estimate();  // the sensor is the same
  odometry_.emplace(config_);
  odometry_->resume_beams(beams);
  seq_ = 0;
  restarts_ = 0;
  resets_ = resets;
  counters_.resets_done.store(resets, std::memory_order_release);
}

// A robot wants the pose of now: once the ring was full, all waiting scans but the newest go. The
// odometry sees the gap in the stamps.
void Worker::skip_to_newest() {
  while (scans_.size() > 1) {
    scans_.release();
    add(counters_.scans_skipped);
  }
}

void Worker::align(ScanSlot& slot) {
  timer_.last_ns = monotonic_ns();
  const Estimate estimate = odometry_->align(slot.scan, slot.features, timer_.hook());
  if (estimate.restarts != restarts_) seq_ = 0;
  restarts_ = estimate.restarts;
  report(slot, estimate);
  ++seq_;
  add(counters_.scans_processed);
}

// The stages of the next report begin here: the map is of no use to who waits for this pose.
void Worker::update_map(const ScanSlot& slot) {
  timer_ = {.last_ns = monotonic_ns()};
  odometry_->update_map(slot.features, timer_.hook());
  beams_.store(odometry_->beam_estimate());
}

void Worker::report(const ScanSlot& slot, const Estimate& estimate) {
  PoseReport* report = reports_.reserve();
  if (report == nullptr) {
    add(counters_.reports_dropped);
    return;
  }
  *report = {.estimate = estimate,
             .seq = seq_,
             .last_packet_ns = slot.last_packet_ns,
             .processing_ns = std::reduce(timer_.stage_ns.begin(), timer_.stage_ns.end()),
             .stage_ns = timer_.stage_ns,
             .packets = slot.scan.packets,
             .clock = slot.scan.clock,
             .scan_complete = slot.scan.complete,
             .tilt_rad = odometry_->tilt_rad(),
             .resets = resets_,
             .worker_minor_faults = minor_faults()};
  report->stage_ns[static_cast<std::size_t>(Stage::project)] += slot.extraction_ns;
  reports_.commit();
  report_ready_.signal();
}

// The pose is out; who looks on waits for nobody's sake, and misses what finds no room.
void Worker::report_points(const ScanSlot& slot) {
  PointsReport* out = points_.ring.reserve();
  if (out == nullptr) return;
  out->seq = seq_ - 1;  // align() counted this scan
  out->resets = resets_;
  out->restarts = restarts_;
  out->stamp_ns = slot.scan.end_ns;
  odometry_->aligned_points(points_.most_of_scan, out->scan_m);
  odometry_->mapped_points(points_.most_of_map, out->map_m);
  points_.ring.commit();
  report_ready_.signal();
}

}  // namespace lilo
