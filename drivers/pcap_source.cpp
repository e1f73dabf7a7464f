// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/link_layer.hpp"
#include "drivers/packet_source.hpp"

#include <pcap/pcap.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

namespace lilo {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // what int64 nanoseconds can hold
// Of a file, at a time: stdio's own 4 kB are three packets, and each such read is a system call.
constexpr std::size_t kReadBytes = 1U << 16U;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct ClosePcap {
  void operator()(pcap_t* pcap) const { pcap_close(pcap); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;
using Pcap = std::unique_ptr<pcap_t, ClosePcap>;

/// What libpcap's complaint about a record means.
std::string reason_of(const std::string& complaint) {
  // A pcapng file may hold several; libpcap reads the packets before the second kind.
  if (complaint.find("of the first interface") == std::string::npos)
    return "ends inside a record or is damaged: " + complaint;
  return "expected interfaces that are all alike, of the rest nothing is read: " + complaint;
}

std::string link_name(int link_type) {
  const char* name = pcap_datalink_val_to_name(link_type);
  return name != nullptr ? name : std::to_string(link_type);
}

class PcapSource final : public PacketSource {
 public:
  explicit PcapSource(const std::string& path);
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override;
  [[nodiscard]] SourceCounts counts() const override { return counts_; }
  [[nodiscard]] double progress() const override;
  [[nodiscard]] std::string link_type() const override { return link_name(link_type_); }
  [[nodiscard]] std::string error() const override { return error_; }

 private:
  bool count(FrameKind kind);

  std::string name_;
  double file_bytes_ = 0.0;
  std::vector<char> buffer_;  // of the file, which pcap_ closes: it must outlive that
  Pcap pcap_;
  int link_type_ = 0;
  bool ended_ = false;
  SourceCounts counts_;
  std::string error_;
};

File open_file(const std::string& path) {
  if (path == "-") return File(stdin);
  if (std::filesystem::is_directory(path))
    throw DriverError(path + ": expected a capture file, found a folder");
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw DriverError(path + ": cannot be opened: " + std::strerror(errno));
  return file;
}

PcapSource::PcapSource(const std::string& path) : name_(path == "-" ? "standard input" : path) {
  File file = open_file(path);
  if (path != "-") {
    std::error_code unknown;
    const auto bytes = std::filesystem::file_size(path, unknown);
    file_bytes_ = unknown ? 0.0 : static_cast<double>(bytes);
    if (!unknown && bytes == 0 && std::filesystem::is_regular_file(path))
      throw DriverError(path + ": expected a pcap or pcapng capture, found an empty file");
    // Standard input outlives us, and keeps its own.
    buffer_.resize(kReadBytes);
    std::setvbuf(file.get(), buffer_.data(), _IOFBF, buffer_.size());
  }
  std::array<char, PCAP_ERRBUF_SIZE> reason{};
  pcap_.reset(pcap_fopen_offline_with_tstamp_precision(file.get(), PCAP_TSTAMP_PRECISION_NANO,
                                                       reason.data()));
  if (!pcap_)
    throw DriverError(name_ + ": expected a pcap or pcapng capture, found: " + reason.data());
  (void)file.release();  // pcap_close() closes it
  link_type_ = pcap_datalink(pcap_.get());
  if (!is_known_link_type(link_type_))
    throw DriverError(name_ + ": expected frames of Ethernet, Linux cooked or raw IP, found " +
                      link_name(link_type_));
}

bool PcapSource::count(FrameKind kind) {
  switch (kind) {
    case FrameKind::udp:
      ++counts_.packets;
      return true;
    case FrameKind::foreign:
      ++counts_.foreign;
      return false;
    case FrameKind::fragment:
      ++counts_.fragments;
      return false;
    case FrameKind::truncated:
      ++counts_.truncated;
      return false;
  }
  return false;
}

ReadResult PcapSource::read(PacketView& packet, std::chrono::milliseconds) {
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  while (!ended_) {
    const int result = pcap_next_ex(pcap_.get(), &header, &bytes);
    if (result != 1) {
      ended_ = true;
      if (result == PCAP_ERROR) error_ = name_ + ": " + reason_of(pcap_geterr(pcap_.get()));
      break;
    }
    const Frame frame = parse_frame(link_type_, std::as_bytes(std::span(bytes, header->caplen)));
    if (!count(frame.kind)) continue;
    // libpcap leaves nanoseconds in tv_usec: that is what the precision asked for means.
    const std::int64_t seconds = header->ts.tv_sec;
    packet = {.received_ns = seconds < 0 || seconds > kMaxSeconds
                                 ? 0
                                 : seconds * kSecondNs + header->ts.tv_usec,
              .source_ipv4 = frame.datagram.source_ipv4,
              .source_port = frame.datagram.source_port,
              .destination_port = frame.datagram.destination_port,
              .payload = frame.datagram.payload};
    return ReadResult::packet;
  }
  return ReadResult::end;
}

double PcapSource::progress() const {
  if (ended_) return 1.0;
  const long at = std::ftell(pcap_file(pcap_.get()));
  return file_bytes_ > 0.0 && at > 0 ? static_cast<double>(at) / file_bytes_ : 0.0;
}

}  // namespace

std::unique_ptr<PacketSource> open_pcap(const std::string& path) {
  return std::make_unique<PcapSource>(path);
}

}  // namespace lilo
