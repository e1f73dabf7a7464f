#pragma once

#include "core/odometry.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/wakeup.hpp"

namespace lilo {

/// Scans to poses, on a thread of its own. Never logs, never locks; allocates only where
/// Odometry::process does.
class Worker {
 public:
  Worker(const OdometryConfig& config, ScanRing& scans, Wakeup& scan_ready, ReportRing& reports,
         Wakeup& report_ready, PipelineCounters& counters);

  /// Until counters.stop; signal scan_ready after setting it.
  void run();

 private:
  void skip_to_newest();
  void process(const ScanSlot& slot);

  Odometry odometry_;
  ScanRing& scans_;
  Wakeup& scan_ready_;
  ReportRing& reports_;
  Wakeup& report_ready_;
  PipelineCounters& counters_;
  std::uint64_t seq_ = 0;
};

}  // namespace lilo
