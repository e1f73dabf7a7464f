// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pcap/pcap_writer.hpp"

#include <fmt/format.h>
#include <pcap/pcap.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <vector>

namespace lilo {
namespace {

constexpr std::size_t kEthernet = 14, kIp = 20, kUdp = 8;

void put_be16(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  bytes[at] = static_cast<std::uint8_t>((value >> 8U) & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>(value & 0xFFU);
}

/// RFC 791: ones' complement of the ones' complement sum.
std::uint32_t ip_checksum(const std::vector<std::uint8_t>& frame) {
  std::uint32_t sum = 0;
  for (std::size_t k = kEthernet; k < kEthernet + kIp; k += 2) {
    sum += (static_cast<std::uint32_t>(frame[k]) << 8U) | frame[k + 1];
  }
  while (sum > 0xFFFFU) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return ~sum & 0xFFFFU;
}

void put_be32(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  put_be16(bytes, at, value >> 16U);
  put_be16(bytes, at + 2, value);
}

/// Everything before the payload, and that. A Velodyne's card is the sender whoever it was: the
/// socket did not see it. UDP checksum 0: none.
std::vector<std::uint8_t> frame_of(const UdpAddresses& addresses,
                                   std::span<const std::byte> payload,
                                   std::uint16_t identification) {
  constexpr std::array<std::uint8_t, kEthernet> kLink{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x60,
                                                      0x76, 0x88, 0x20, 0x12, 0x6E, 0x08, 0x00};
  std::vector<std::uint8_t> frame(kEthernet + kIp + kUdp, 0);
  std::copy(kLink.begin(), kLink.end(), frame.begin());
  frame[kEthernet] = 0x45;
  put_be16(frame, kEthernet + 2, static_cast<std::uint32_t>(kIp + kUdp + payload.size()));
  put_be16(frame, kEthernet + 4, identification);
  put_be16(frame, kEthernet + 6, 0x4000);  // do not fragment
  frame[kEthernet + 8] = 255;
  frame[kEthernet + 9] = 17;
  put_be32(frame, kEthernet + 12, addresses.source_ipv4);
  put_be32(frame, kEthernet + 16, addresses.destination_ipv4);
  put_be16(frame, kEthernet + 10, ip_checksum(frame));
  put_be16(frame, kEthernet + kIp, addresses.source_port);
  put_be16(frame, kEthernet + kIp + 2, addresses.destination_port);
  put_be16(frame, kEthernet + kIp + 4, static_cast<std::uint32_t>(kUdp + payload.size()));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(payload.data());
  frame.insert(frame.end(), bytes, bytes + payload.size());
  return frame;
}

}  // namespace

struct PcapWriter::Impl {
  std::string path;
  std::int64_t tick_ns = 1000;  ///< length of the fraction's unit
  std::uint16_t identification = 0;
  pcap_t* handle = nullptr;
  pcap_dumper_t* dumper = nullptr;
};

PcapWriter::PcapWriter(const std::string& path, bool nanoseconds)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->tick_ns = nanoseconds ? 1 : 1000;
  impl_->handle = pcap_open_dead_with_tstamp_precision(
      DLT_EN10MB, 65535, nanoseconds ? PCAP_TSTAMP_PRECISION_NANO : PCAP_TSTAMP_PRECISION_MICRO);
  impl_->dumper = pcap_dump_open(impl_->handle, path.c_str());
  if (impl_->dumper == nullptr) {
    const std::string reason = pcap_geterr(impl_->handle);
    pcap_close(impl_->handle);
    throw std::runtime_error(reason);  // libpcap's text names the file
  }
}

PcapWriter::~PcapWriter() {
  if (impl_->dumper != nullptr) pcap_dump_close(impl_->dumper);
  if (impl_->handle != nullptr) pcap_close(impl_->handle);
}

void PcapWriter::write(const UdpAddresses& addresses, std::span<const std::byte> payload,
                       std::int64_t received_utc_ns) {
  const std::vector<std::uint8_t> frame = frame_of(addresses, payload, ++impl_->identification);
  pcap_pkthdr header{};
  header.ts.tv_sec = received_utc_ns / 1'000'000'000;
  header.ts.tv_usec = received_utc_ns % 1'000'000'000 / impl_->tick_ns;
  header.caplen = header.len = static_cast<bpf_u_int32>(frame.size());
  // libpcap's callback type: the dumper travels as the user pointer.
  pcap_dump(reinterpret_cast<u_char*>(impl_->dumper), &header, frame.data());
}

void PcapWriter::close() {
  const bool failed =
      pcap_dump_flush(impl_->dumper) != 0 || std::ferror(pcap_dump_file(impl_->dumper)) != 0;
  if (failed)
    throw std::runtime_error(fmt::format("{}: could not be written completely", impl_->path));
}

}  // namespace lilo
