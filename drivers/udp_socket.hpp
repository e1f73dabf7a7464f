// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/packet_source.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <sys/socket.h>

namespace lilo {

/// One port, read many datagrams at a time into fixed slots, with the kernel's receive times and
/// its count of what it had to drop. Boost.Asio opens and configures; recvmmsg reads.
class UdpSocket {
 public:
  /// `sensor_port` not 0: connected to that port of config.sensor_address. Throws DriverError
  /// naming what cannot be had.
  UdpSocket(boost::asio::io_context& context, const UdpConfig& config, std::uint16_t port,
            std::uint16_t sensor_port = 0);

  /// Takes what is waiting, without waiting. False when there was nothing, or an error.
  bool fill();
  /// The next datagram taken, of any sender; false when all were given out. `truncated` tells that
  /// it was longer than a slot.
  bool next(PacketView& packet, bool& truncated);

  [[nodiscard]] int native() { return socket_.native_handle(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] int receive_buffer_bytes() const { return receive_buffer_bytes_; }
  /// Datagrams the kernel dropped because the buffer was full (SO_RXQ_OVFL).
  [[nodiscard]] std::uint64_t kernel_dropped() const { return kernel_dropped_; }
  /// Times that reading failed, other than for want of datagrams.
  [[nodiscard]] std::uint64_t receive_errors() const { return receive_errors_; }

 private:
  static constexpr std::size_t kSlots = 64;
  static constexpr std::size_t kSlotBytes = 1536;
  static constexpr std::size_t kControlBytes = 128;

  struct Slot {
    alignas(16) std::array<std::byte, kSlotBytes> bytes;
    alignas(cmsghdr) std::array<std::byte, kControlBytes> control;
    sockaddr_storage sender;
    iovec vector;
  };

  void bind(const UdpConfig& config, std::uint16_t port, std::uint16_t sensor_port);
  void configure(const UdpConfig& config);
  void read_control(msghdr& header, PacketView& packet);

  boost::asio::ip::udp::socket socket_;
  std::uint16_t port_ = 0;
  int receive_buffer_bytes_ = 0;
  std::array<Slot, kSlots> slots_{};
  std::array<mmsghdr, kSlots> headers_{};
  std::size_t filled_ = 0, given_ = 0;
  std::uint32_t drop_counter_ = 0;
  std::uint64_t kernel_dropped_ = 0, receive_errors_ = 0;
};

}  // namespace lilo
