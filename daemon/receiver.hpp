// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature_extractor.hpp"
#include "daemon/calibration_table.hpp"
#include "daemon/packet_message.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/snapshot.hpp"
#include "daemon/wakeup.hpp"
#include "drivers/packet_source.hpp"
#include "drivers/scan_builder.hpp"
#include "drivers/sensor_config.hpp"

#include <atomic>
#include <cstdint>
#include <memory>

namespace lilo {

/// What the drivers know, for other threads.
struct ReceiverState {
  DriverCounts driver;
  SourceCounts source;
  SensorStatus sensor;
};

/// Packets to scans and their features, on a thread of its own. The features are found while the
/// scan is measured, packet by packet, and go into a slot of the ring when it is whole. The returns
/// stay here, unless the profile asks for them. A scan that fills the last free slot asks the
/// worker to skip to the newest one; should there be no slot for the next, it is given up and
/// counted. While counters.packets_asked, it copies every packet into a ring of its own; should
/// that be full, the packet is counted and left out.
class Receiver : private ScanSink {
 public:
  Receiver(std::unique_ptr<PacketSource> source, const SensorConfig& sensor,
           const OdometryConfig& odometry, ScanRing& scans, Wakeup& scan_ready,
           PipelineCounters& counters, PacketRing* packets = nullptr);

  /// Until counters.stop, or the end of a source that has one. No allocation once every slot has
  /// held a scan.
  void run();

  /// Any thread: as of the last scan, and while there are none of the last 512 packets or 100 ms.
  [[nodiscard]] const Snapshot<ReceiverState>& state() const { return state_; }
  /// Any thread: tables read from the packets of an HDL-64E so far, and the last of them.
  [[nodiscard]] std::uint64_t calibrations_read() const { return calibrations_read_.load(); }
  [[nodiscard]] const Snapshot<CalibrationTable>& calibration() const { return calibration_; }
  /// Any thread: monotonic time of the last packet that was read; 0: none yet.
  [[nodiscard]] std::int64_t last_packet_ns() const { return last_packet_ns_.load(); }
  /// Any thread: monotonic time at which the last scan was complete; 0: none yet.
  [[nodiscard]] std::int64_t last_scan_ns() const { return last_scan_ns_.load(); }

 private:
  Scan& exchange(Scan& finished) override;
  void inserted(std::size_t index) override { extractor_.inserted(index); }
  void copy(const PacketView& packet);
  void follow_scan();
  void hand_on(Scan& finished, ScanSlot& slot);
  void share_state();
  void share_calibration(const SensorStatus& status);

  std::unique_ptr<PacketSource> source_;
  ScanRing& scans_;
  Wakeup& scan_ready_;
  PipelineCounters& counters_;
  PacketRing* packets_;  // null: nobody may ask
  std::uint64_t packets_read_ = 0;
  bool needs_returns_;  // the profile
  Scan scan_;           // being written
  FeatureExtractor extractor_;
  std::int64_t extraction_ns_ = 0;  // for its features so far
  std::size_t most_returns_ = 0;    // of any scan
  std::atomic<std::int64_t> last_packet_ns_{0};
  std::atomic<std::int64_t> last_scan_ns_{0};
  Snapshot<ReceiverState> state_;
  CalibrationTable last_calibration_;  // that was shared
  std::atomic<std::uint64_t> calibrations_read_{0};
  Snapshot<CalibrationTable> calibration_;
  ScanBuilder builder_;
};

/// Reserve and touch the memory that a scan of this sensor needs, and what the profile wants of it.
void prepare_scan(Scan& scan, SensorModel model);
void prepare_slot(ScanSlot& slot, SensorModel model, const OdometryConfig& odometry);

}  // namespace lilo
