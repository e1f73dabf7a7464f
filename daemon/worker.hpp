#pragma once

#include "core/odometry.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/wakeup.hpp"

#include <cstdint>
#include <optional>

namespace lilo {

/// Scans to poses, on a thread of its own. Never logs, never locks; allocates only where
/// Odometry::process does, for a reset, and to copy the map.
class Worker {
 public:
  Worker(const OdometryConfig& config, ScanRing& scans, Wakeup& scan_ready, ReportRing& reports,
         Wakeup& report_ready, PipelineCounters& counters);

  /// Until counters.stop; signal scan_ready after setting it.
  void run();

  /// The copy that counters.maps_asked asked for. For the one who asked, once maps_done has
  /// followed and until maps_asked changes again.
  [[nodiscard]] MapCopy& map_copy() { return map_copy_; }

 private:
  void copy_map(std::uint64_t asked);
  void begin_again(std::uint64_t resets);
  void skip_to_newest();
  void process(const ScanSlot& slot);

  OdometryConfig config_;
  std::optional<Odometry> odometry_;
  ScanRing& scans_;
  Wakeup& scan_ready_;
  ReportRing& reports_;
  Wakeup& report_ready_;
  PipelineCounters& counters_;
  std::uint64_t seq_ = 0;
  std::uint64_t resets_ = 0;
  MapCopy map_copy_;
};

}  // namespace lilo
