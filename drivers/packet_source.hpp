// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

namespace lilo {

/// What went wrong when a source, a calibration or a scan folder was opened: one line for the user
/// that names the file or address, what was expected and what was found.
class DriverError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One UDP payload. The bytes belong to the source and live until its next read().
struct PacketView {
  std::int64_t received_ns = 0;   ///< UTC, by the capturing computer's clock
  std::uint32_t source_ipv4 = 0;  ///< host byte order; 0 where unknown
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::span<const std::byte> payload;
};

enum class ReadResult : std::uint8_t { packet, timeout, end };

/// What a source left out and why. Nothing of this is fatal.
struct SourceCounts {
  std::uint64_t packets = 0;         ///< handed on
  std::uint64_t foreign = 0;         ///< not UDP, another port or another sender
  std::uint64_t truncated = 0;       ///< shorter than their own headers say
  std::uint64_t fragments = 0;       ///< IP fragments, never reassembled
  std::uint64_t kernel_dropped = 0;  ///< the socket buffer was full (live only)
  std::uint64_t receive_errors = 0;  ///< failures to read from a socket (live only)
};

/// Where packets come from. One thread reads.
class PacketSource {
 public:
  PacketSource() = default;
  PacketSource(const PacketSource&) = delete;
  PacketSource& operator=(const PacketSource&) = delete;
  virtual ~PacketSource() = default;

  /// Waits at most `timeout` (a file never waits). Never throws on what it reads.
  virtual ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) = 0;
  [[nodiscard]] virtual SourceCounts counts() const = 0;
  /// Part of a file already read, in [0, 1]; 0 for a live source.
  [[nodiscard]] virtual double progress() const { return 0.0; }
  /// How a capture's frames begin, by libpcap's name (EN10MB is Ethernet, LINUX_SLL cooked); empty
  /// for a live source.
  [[nodiscard]] virtual std::string link_type() const { return {}; }
  /// Why the data ended early, one line for the user; empty while nothing is wrong. A file that
  /// ends inside a record gives all it holds before this is set.
  [[nodiscard]] virtual std::string error() const { return {}; }
};

/// UDP packets of a capture (pcap of either byte order and resolution, pcapng), in file order. "-"
/// is standard input. Throws DriverError when the file is missing, empty or no capture; a file that
/// ends inside a record ends there, and error() says so.
std::unique_ptr<PacketSource> open_pcap(const std::string& path);

struct UdpConfig {
  std::string bind_address = "0.0.0.0";
  std::uint16_t data_port = 2368;
  std::uint16_t position_port = 8308;  ///< 0: do not listen
  std::string sensor_address;          ///< only packets from here; empty: from anywhere
  std::string multicast_group;         ///< joined when set
  /// Other programs may listen to the same ports, each to its own sensor, unicast and broadcast.
  /// Needs sensor_address, and for unicast the ports it sends from.
  bool share_ports = false;
  std::uint16_t sensor_data_port = 2368, sensor_position_port = 8308;
  int receive_buffer_bytes = 4 << 20;  ///< asked of the kernel, which may grant less
};

/// Live packets. Two ports of one sensor, whichever has one first.
class UdpSource : public PacketSource {
 public:
  /// What the kernel granted of UdpConfig::receive_buffer_bytes, as it counts it (getsockopt).
  [[nodiscard]] virtual int receive_buffer_bytes() const = 0;
  /// The port data come in on: the configured one, or the kernel's choice where that was 0.
  [[nodiscard]] virtual std::uint16_t data_port() const = 0;
};

/// Throws DriverError when an address is none or cannot be bound.
std::unique_ptr<UdpSource> open_udp(const UdpConfig& config);

}  // namespace lilo
