// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/pcap_scans.hpp"

#include "drivers/calibration.hpp"
#include "drivers/packet_source.hpp"

#include <utility>

namespace lilo {
namespace {

// Reading ahead for the table stops here: three laps of the status bytes, and then some.
constexpr std::uint64_t kMaxPacketsAhead = 16'000;

// Takes scans and keeps none.
class NoScans final : public ScanSink {
 public:
  Scan& exchange(Scan& finished) override {
    finished.clear();
    return finished;
  }
};

// The table an HDL-64E's capture carries, so that the first revolution can be used. A capture read
// from standard input cannot be read twice: there the revolutions before the table are lost.
void read_table_ahead(const std::string& path, const SensorConfig& config, ScanBuilder& builder) {
  if (path == "-" || builder.calibration() != nullptr) return;
  Scan scan;
  NoScans sink;
  ScanBuilder ahead(config, scan, sink);
  const auto packets = open_pcap(path);
  PacketView packet;
  while (packets->read(packet, std::chrono::milliseconds(0)) == ReadResult::packet) {
    ahead.feed(packet);
    const SensorModel model = ahead.status().model;
    const bool useless = model != SensorModel::automatic && model != SensorModel::hdl64e;
    if (useless || ahead.counts().data_packets > kMaxPacketsAhead) return;
    if (ahead.calibration() == nullptr) continue;
    builder.use_calibration(*ahead.calibration());
    return;
  }
}

// Two scans take turns: one is written, the other waits to be fetched or is with the caller, who
// brings it back. So the memory of no third one goes round through the caches.
class PcapScans final : public ScanSource, private ScanSink {
 public:
  PcapScans(const std::string& path, const SensorConfig& config)
      : packets_(open_pcap(path)), builder_(config, scans_[0], *this) {
    read_table_ahead(path, config, builder_);
  }

  bool next(Scan& scan) override {
    std::swap(scan, *idle_);
    while (finished_ == nullptr) {
      PacketView packet;
      if (packets_->read(packet, std::chrono::milliseconds(0)) != ReadResult::packet) return false;
      if (received_.first_ns == 0) received_.first_ns = packet.received_ns;
      received_.last_ns = packet.received_ns;
      builder_.feed(packet);
    }
    std::swap(scan, *std::exchange(finished_, nullptr));
    return true;
  }
  [[nodiscard]] DriverCounts driver_counts() const override { return builder_.counts(); }
  [[nodiscard]] SourceCounts source_counts() const override { return packets_->counts(); }
  [[nodiscard]] SensorStatus sensor_status() const override { return builder_.status(); }
  [[nodiscard]] ReceivedSpan received() const override { return received_; }
  [[nodiscard]] double progress() const override { return packets_->progress(); }
  [[nodiscard]] std::string link_type() const override { return packets_->link_type(); }
  [[nodiscard]] std::string error() const override { return packets_->error(); }

 private:
  // A packet ends at most one scan: it spans less than a revolution.
  Scan& exchange(Scan& finished) override {
    finished_ = &finished;
    return *std::exchange(idle_, &finished);
  }

  std::unique_ptr<PacketSource> packets_;
  ReceivedSpan received_;
  Scan scans_[2];
  Scan* idle_ = &scans_[1];  // not the one being written
  Scan* finished_ = nullptr;
  ScanBuilder builder_;
};

}  // namespace

std::unique_ptr<ScanSource> open_pcap_scans(const std::string& path, const SensorConfig& config) {
  SensorConfig own = config;
  own.state_directory.clear();  // what is stored is of the sensor of this computer
  return std::make_unique<PcapScans>(path, own);
}

}  // namespace lilo
