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
/// scan is measured, packet by packet. Writes straight into ring slots. When the worker holds
/// them all, the receiver writes into a spare one and asks the worker to skip to the newest scan.
/// While counters.packets_asked, it copies every packet into a ring of its own; should that be
/// full, the packet is counted and left out.
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
  void share_state();
  void share_calibration(const SensorStatus& status);

  std::unique_ptr<PacketSource> source_;
  ScanRing& scans_;
  Wakeup& scan_ready_;
  PipelineCounters& counters_;
  PacketRing* packets_;  // null: nobody may ask
  std::uint64_t packets_read_ = 0;
  ScanSlot spare_;
  ScanSlot* writing_;
  FeatureExtractor extractor_;
  std::size_t most_returns_ = 0;  // of any scan
  std::atomic<std::int64_t> last_packet_ns_{0};
  std::atomic<std::int64_t> last_scan_ns_{0};
  Snapshot<ReceiverState> state_;
  CalibrationTable last_calibration_;  // that was shared
  std::atomic<std::uint64_t> calibrations_read_{0};
  Snapshot<CalibrationTable> calibration_;
  ScanBuilder builder_;
};

/// Reserves and touches the memory that a scan of this sensor and its features need.
void prepare_slot(ScanSlot& slot, SensorModel model, const OdometryConfig& odometry);

}  // namespace lilo
