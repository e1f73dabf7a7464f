// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/snapshot.hpp"
#include "daemon/wakeup.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace lilo {

/// The worker's time in each stage. A stage that ends twice in a scan counts both.
struct StageTimer {
  std::array<std::int64_t, kStageCount> stage_ns{};
  std::int64_t last_ns = 0;  ///< monotonic, when the last stage ended

  StageHook hook();
};

/// Where points go, and how many of each kind a scan may bring.
struct PointsOutput {
  PointsRing& ring;
  std::size_t most_of_scan = 0, most_of_map = 0;
};

/// Scans to poses, on a thread of its own. Never logs, never locks; allocates only where
/// Odometry does, for a reset, and to copy the map.
class Worker {
 public:
  /// `kept`: what an earlier run found of the beams.
  Worker(const OdometryConfig& config, const BeamEstimate& kept, ScanRing& scans,
         Wakeup& scan_ready, ReportRing& reports, PointsOutput points, Wakeup& report_ready,
         PipelineCounters& counters);

  /// Until counters.stop; signal scan_ready after setting it.
  void run();

  /// The copy that counters.maps_asked asked for. For the one who asked, once maps_done has
  /// followed and until maps_asked changes again.
  [[nodiscard]] MapCopy& map_copy() { return map_copy_; }
  /// What has been found of the beams up to the last scan.
  [[nodiscard]] const Snapshot<BeamEstimate>& beams() const { return beams_; }

 private:
  void copy_map(std::uint64_t asked);
  void begin_again(std::uint64_t resets);
  void skip_to_newest();
  void align(ScanSlot& slot);
  void report(const ScanSlot& slot, const Estimate& estimate);
  void update_map(const ScanSlot& slot);
  void report_points(const ScanSlot& slot);

  OdometryConfig config_;
  std::optional<Odometry> odometry_;
  ScanRing& scans_;
  Wakeup& scan_ready_;
  ReportRing& reports_;
  PointsOutput points_;
  Wakeup& report_ready_;
  PipelineCounters& counters_;
  std::uint64_t seq_ = 0;
  std::uint64_t resets_ = 0;
  std::uint32_t restarts_ = 0;  // of the odometry in force
  StageTimer timer_;
  MapCopy map_copy_;
  Snapshot<BeamEstimate> beams_;
};

}  // namespace lilo
