#include "drivers/pcap_scans.hpp"

#include "drivers/packet_source.hpp"

#include <utility>

namespace lilo {
namespace {

// Two scans take turns: one is written while the other waits to be fetched.
class PcapScans final : public ScanSource, private ScanSink {
 public:
  PcapScans(const std::string& path, const SensorConfig& config)
      : packets_(open_pcap(path)), builder_(config, scans_[0], *this) {}

  bool next(Scan& scan) override {
    while (finished_ == nullptr) {
      PacketView packet;
      if (packets_->read(packet, std::chrono::milliseconds(0)) != ReadResult::packet) return false;
      builder_.feed(packet);
    }
    std::swap(scan, *std::exchange(finished_, nullptr));
    return true;
  }
  [[nodiscard]] DriverCounts driver_counts() const override { return builder_.counts(); }
  [[nodiscard]] SourceCounts source_counts() const override { return packets_->counts(); }
  [[nodiscard]] double progress() const override { return packets_->progress(); }
  [[nodiscard]] std::string error() const override { return packets_->error(); }

 private:
  // A packet ends at most one scan: it spans less than a revolution.
  Scan& exchange(Scan& finished) override {
    finished_ = &finished;
    return &finished == &scans_[0] ? scans_[1] : scans_[0];
  }

  std::unique_ptr<PacketSource> packets_;
  Scan scans_[2];
  Scan* finished_ = nullptr;
  ScanBuilder builder_;
};

}  // namespace

std::unique_ptr<ScanSource> open_pcap_scans(const std::string& path, const SensorConfig& config) {
  return std::make_unique<PcapScans>(path, config);
}

}  // namespace lilo
