// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/realtime.hpp"
#include "daemon/receiver.hpp"
#include "daemon/wakeup.hpp"
#include "daemon/worker.hpp"

#include <memory>
#include <optional>
#include <thread>

namespace lilo {

/// The receiver and the worker thread with what lies between them. The thread that owns the engine
/// is the consumer of reports().
class Engine {
 public:
  /// Takes the source, reserves all memory. Throws DriverError when the calibration cannot be read.
  Engine(const Config& config, std::unique_ptr<PacketSource> source);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Starts both threads and returns once each has its policy, and the calling thread its own.
  RealtimeReport start();
  /// Ends both threads and waits for them.
  void stop();

  [[nodiscard]] ReportRing& reports() { return reports_; }
  /// What was seen with the poses, while want_points() says so.
  [[nodiscard]] PointsRing& points() { return points_; }
  void want_points(bool wanted) { counters_.points_asked = wanted; }
  /// The sensor's packets, while want_packets() says so.
  [[nodiscard]] PacketRing& packets() { return packets_; }
  void want_packets(bool wanted) { counters_.packets_asked = wanted; }
  [[nodiscard]] Wakeup& report_ready() { return report_ready_; }
  [[nodiscard]] const PipelineCounters& counters() const { return counters_; }
  [[nodiscard]] const Receiver& receiver() const { return receiver_; }
  [[nodiscard]] const Snapshot<BeamEstimate>& beams() const { return worker_.beams(); }
  /// The next scan starts a new odometry. False while the last one that was asked for has not
  /// begun.
  bool reset();
  /// The worker will copy its map between two scans and signal report_ready(). False while the
  /// last copy that was asked for was not taken.
  bool ask_map();
  /// The copy, once it is there.
  std::optional<MapCopy> take_map();
  [[nodiscard]] std::size_t ring_slots() const { return scans_.capacity(); }
  /// Scans that wait or are being processed.
  [[nodiscard]] std::size_t scans_waiting() const { return scans_.size(); }

 private:
  RealtimeConfig realtime_;
  PipelineCounters counters_;
  Wakeup scan_ready_{Wakeup::Mode::blocking};
  Wakeup report_ready_{Wakeup::Mode::polled};
  ScanRing scans_;
  ReportRing reports_;
  PointsRing points_;
  PacketRing packets_;
  Receiver receiver_;
  Worker worker_;
  bool map_asked_ = false;  // and not yet taken
  std::thread receiver_thread_, worker_thread_;
};

}  // namespace lilo
