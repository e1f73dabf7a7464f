// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"
#include "core/feature_extractor.hpp"
#include "core/odometry.hpp"
#include "core/scan.hpp"
#include "drivers/scan_builder.hpp"
#include "drivers/spsc_ring.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

/// What the three threads hand to each other:
///   receiver ==ScanSlot==> worker ==PoseReport==> publisher, and counters that all may read.
///                                ==PointsReport==>  while a client has asked for points
///   receiver ==PacketDatagram==>              publisher, while a client has asked for packets
namespace lilo {

struct ScanSlot {
  Scan scan;                        ///< without returns, unless the profile needs them: paper
  ScanFeatures features;            ///< of the whole scan
  std::int64_t extraction_ns = 0;   ///< the receiver's time for them
  std::int64_t last_packet_ns = 0;  ///< monotonic time at which the packet that ended it arrived
};

struct PoseReport {
  Estimate estimate;
  std::uint64_t seq = 0;            ///< poses of this session before this one
  std::int64_t last_packet_ns = 0;  ///< monotonic, as in ScanSlot
  std::int64_t processing_ns = 0;   ///< the worker's time for this pose, and before it for the map
  std::array<std::int64_t, kStageCount> stage_ns{};  ///< project: the receiver's; map: of the last
  PacketCounts packets;
  ClockSource clock = ClockSource::host;
  bool scan_complete = true;
  double tilt_rad = 0.0;                  ///< Odometry::tilt_rad()
  std::uint64_t resets = 0;               ///< odometries begun before this one
  std::uint64_t worker_minor_faults = 0;  ///< page faults of the thread since its start
};

/// What the odometry saw of one scan, for clients who look on. In the sensor's frame at the instant
/// of the pose. Its memory is reserved once.
struct PointsReport {
  std::uint64_t seq = 0;       ///< as in PoseReport,
  std::uint64_t resets = 0;    ///< and of the same odometry
  std::uint32_t restarts = 0;  ///< as in Estimate
  std::int64_t stamp_ns = 0;
  std::vector<Eigen::Vector3f> scan_m;  ///< what the scan was aligned by
  std::vector<Eigen::Vector3f> map_m;   ///< what it added to the map
};

/// The odometry's map at one instant, for saving.
struct MapCopy {
  std::vector<Eigen::Vector3f> points_m;  ///< in the odometry's own frame
  std::uint64_t resets = 0;               ///< as in PoseReport: of which odometry
};

using ScanRing = SpscRing<ScanSlot>;
using ReportRing = SpscRing<PoseReport>;
using PointsRing = SpscRing<PointsReport>;

/// Each counter has one writer; any thread reads. Totals since the start.
struct PipelineCounters {
  std::atomic<std::uint64_t> scans_received{0};   ///< receiver
  std::atomic<std::uint64_t> scans_overrun{0};    ///< receiver: no slot was free
  std::atomic<std::uint64_t> scans_skipped{0};    ///< worker: passed over to catch up
  std::atomic<std::uint64_t> scans_processed{0};  ///< worker
  std::atomic<std::uint64_t> reports_dropped{0};  ///< worker: the publisher was asleep
  std::atomic<std::uint64_t> ring_high_water{0};  ///< receiver: most scans that ever waited
  std::atomic<std::uint64_t> packets_dropped{0};  ///< receiver: asked for, but no slot was free
  std::atomic<std::uint64_t> resets_asked{0};     ///< publisher
  std::atomic<std::uint64_t> resets_done{0};      ///< worker
  std::atomic<std::uint64_t> maps_asked{0};       ///< publisher
  std::atomic<std::uint64_t> maps_done{0};        ///< worker
  std::atomic<bool> points_asked{false};          ///< publisher: somebody looks on
  std::atomic<bool> packets_asked{false};         ///< publisher: somebody records packets
  std::atomic<bool> behind{false};                ///< receiver asks, worker answers by skipping
  std::atomic<bool> stop{false};                  ///< publisher asks both to end
};

}  // namespace lilo
