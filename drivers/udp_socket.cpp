// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/udp_socket.hpp"

#include <boost/asio/ip/multicast.hpp>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <netinet/in.h>
#include <sys/time.h>

namespace lilo {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;

asio::ip::address_v4 address_of(const std::string& text, const char* what) {
  boost::system::error_code error;
  auto address = asio::ip::make_address_v4(text, error);
  if (error)
    throw DriverError(std::string(what) + ": expected an IPv4 address, found \"" + text + "\"");
  return address;
}

void check(const boost::system::error_code& error, const std::string& what) {
  if (error) throw DriverError(what + ": " + error.message());
}

std::int64_t host_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

UdpSocket::UdpSocket(asio::io_context& context, const UdpConfig& config, std::uint16_t port,
                     std::uint16_t sensor_port)
    : socket_(context) {
  bind(config, port, sensor_port);
  configure(config);
  for (std::size_t i = 0; i < kSlots; ++i) {
    Slot& slot = slots_[i];
    slot.vector = {slot.bytes.data(), slot.bytes.size()};
    headers_[i].msg_hdr = {.msg_name = &slot.sender,
                           .msg_namelen = sizeof(slot.sender),
                           .msg_iov = &slot.vector,
                           .msg_iovlen = 1,
                           .msg_control = slot.control.data(),
                           .msg_controllen = slot.control.size(),
                           .msg_flags = 0};
  }
}

void UdpSocket::bind(const UdpConfig& config, std::uint16_t port, std::uint16_t sensor_port) {
  const auto address = address_of(config.bind_address, "bind address");
  const std::string where = config.bind_address + ":" + std::to_string(port);
  boost::system::error_code error;
  socket_.open(udp::v4(), error);
  check(error, "UDP socket cannot be opened");
  if (!config.multicast_group.empty() || config.share_ports) {
    // Of sockets bound alike, each has all multicasts and broadcasts, but one alone has the
    // unicast: that which is connected to its sender, else the last one.
    socket_.set_option(asio::socket_base::reuse_address(true), error);
    check(error, where + ": address cannot be shared");
  }
  socket_.bind({address, port}, error);
  const bool taken = error == asio::error::address_in_use;
  check(error, where + ": cannot listen there" +
                   (taken ? " (another program does; two lilods: udp.share_ports)" : ""));
  port_ = socket_.local_endpoint(error).port();
  if (sensor_port == 0) return;
  const auto sensor = address_of(config.sensor_address, "sensor address");
  socket_.connect({sensor, sensor_port}, error);
  check(error, where + ": cannot be kept for the sensor at " + config.sensor_address);
}

void UdpSocket::configure(const UdpConfig& config) {
  boost::system::error_code error;
  // The kernel grants less than asked without a word: what it gave is read back.
  socket_.set_option(asio::socket_base::receive_buffer_size(config.receive_buffer_bytes), error);
  asio::socket_base::receive_buffer_size granted;
  socket_.get_option(granted, error);
  receive_buffer_bytes_ = granted.value();

  const int on = 1;
  if (setsockopt(native(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on)) != 0 ||
      setsockopt(native(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on)) != 0)
    throw DriverError(std::string("UDP socket: receive times or drop count cannot be had: ") +
                      std::strerror(errno));
  if (!config.multicast_group.empty()) {
    const auto group = address_of(config.multicast_group, "multicast group");
    const auto local = address_of(config.bind_address, "bind address");
    socket_.set_option(asio::ip::multicast::join_group(group, local), error);
    check(error, config.multicast_group + ": multicast group cannot be joined");
  }
  socket_.non_blocking(true, error);
  check(error, "UDP socket");
}

bool UdpSocket::fill() {
  for (std::size_t i = 0; i < filled_; ++i) {  // the kernel wrote the lengths of the last batch
    headers_[i].msg_hdr.msg_namelen = sizeof(sockaddr_storage);
    headers_[i].msg_hdr.msg_controllen = kControlBytes;
  }
  const int got = recvmmsg(native(), headers_.data(), kSlots, MSG_DONTWAIT, nullptr);
  if (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) ++receive_errors_;
  filled_ = got > 0 ? static_cast<std::size_t>(got) : 0;
  given_ = 0;
  return filled_ > 0;
}

bool UdpSocket::next(PacketView& packet, bool& truncated) {
  if (given_ == filled_) return false;
  Slot& slot = slots_[given_];
  mmsghdr& header = headers_[given_++];
  truncated = (header.msg_hdr.msg_flags & MSG_TRUNC) != 0;
  sockaddr_in sender{};
  std::memcpy(&sender, &slot.sender, sizeof(sender));
  packet = {.received_ns = 0,
            .source_ipv4 = ntohl(sender.sin_addr.s_addr),
            .source_port = ntohs(sender.sin_port),
            .destination_port = port_,
            .payload = std::span<const std::byte>(slot.bytes.data(), header.msg_len)};
  read_control(header.msg_hdr, packet);
  if (packet.received_ns == 0) packet.received_ns = host_now_ns();
  return true;
}

void UdpSocket::read_control(msghdr& header, PacketView& packet) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(c), sizeof(time));
      packet.received_ns = std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(c), sizeof(dropped));
      kernel_dropped_ += dropped - drop_counter_;  // the kernel's counter wraps: so does this
      drop_counter_ = dropped;
    }
  }
}

}  // namespace lilo
