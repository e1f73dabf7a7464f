// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_source.hpp"
#include "drivers/udp_socket.hpp"

#include <boost/asio/ip/address_v4.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <poll.h>
#include <thread>

namespace lilo {
namespace {

// Short enough for the socket's buffer to hold what comes meanwhile.
constexpr std::chrono::milliseconds kAfterAnError{10};

class TwoPortSource final : public UdpSource {
 public:
  explicit TwoPortSource(const UdpConfig& config);
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override;
  [[nodiscard]] SourceCounts counts() const override;
  [[nodiscard]] int receive_buffer_bytes() const override {
    return sockets_[kData]->receive_buffer_bytes();
  }
  [[nodiscard]] std::uint16_t data_port() const override { return sockets_[kData]->port(); }

 private:
  // Position packets first: they are few, and what they say is about the data that follow. Of
  // shared ports, the sockets connected to the sensor have what it sends to this computer, the
  // others what it broadcasts. Those need not be connected: of unicast, a connected socket gets
  // what is its own before them, and what else comes to them is left out.
  enum : std::size_t { kPosition, kPositionConnected, kData, kDataConnected, kSockets };

  bool take(UdpSocket& socket, PacketView& packet);
  bool take_any(PacketView& packet);
  bool fill();
  [[nodiscard]] std::uint64_t receive_errors() const;
  bool wait(std::chrono::milliseconds timeout);

  boost::asio::io_context context_;
  std::array<std::optional<UdpSocket>, kSockets> sockets_;
  std::uint32_t sensor_ipv4_ = 0;  // 0: any
  SourceCounts counts_;
};

std::uint32_t sensor_address_of(const std::string& text) {
  if (text.empty()) return 0;
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address_v4(text, error);
  if (error) throw DriverError("sensor address: expected an IPv4 address, found \"" + text + "\"");
  return address.to_uint();
}

TwoPortSource::TwoPortSource(const UdpConfig& config)
    : sensor_ipv4_(sensor_address_of(config.sensor_address)) {
  sockets_[kData].emplace(context_, config, config.data_port);
  if (config.position_port != 0)
    sockets_[kPosition].emplace(context_, config, config.position_port);
  if (!config.share_ports) return;
  sockets_[kDataConnected].emplace(context_, config, data_port(), config.sensor_data_port);
  if (config.position_port != 0) {
    sockets_[kPositionConnected].emplace(context_, config, config.position_port,
                                         config.sensor_position_port);
  }
}

SourceCounts TwoPortSource::counts() const {
  SourceCounts counts = counts_;
  for (const auto& socket : sockets_) {
    if (socket) counts.kernel_dropped += socket->kernel_dropped();
  }
  counts.receive_errors = receive_errors();
  return counts;
}

std::uint64_t TwoPortSource::receive_errors() const {
  std::uint64_t errors = 0;
  for (const auto& socket : sockets_) {
    if (socket) errors += socket->receive_errors();
  }
  return errors;
}

bool TwoPortSource::take(UdpSocket& socket, PacketView& packet) {
  bool truncated = false;
  while (socket.next(packet, truncated)) {
    if (sensor_ipv4_ != 0 && packet.source_ipv4 != sensor_ipv4_) {
      ++counts_.foreign;
    } else if (truncated) {
      ++counts_.truncated;
    } else {
      ++counts_.packets;
      return true;
    }
  }
  return false;
}

bool TwoPortSource::take_any(PacketView& packet) {
  return std::any_of(sockets_.begin(), sockets_.end(), [&](std::optional<UdpSocket>& socket) {
    return socket && take(*socket, packet);
  });
}

bool TwoPortSource::wait(std::chrono::milliseconds timeout) {
  std::array<pollfd, kSockets> ports{};
  nfds_t count = 0;
  for (auto& socket : sockets_) {
    if (socket) ports[count++] = {.fd = socket->native(), .events = POLLIN, .revents = 0};
  }
  return poll(ports.data(), count, static_cast<int>(timeout.count())) > 0;
}

ReadResult TwoPortSource::read(PacketView& packet, std::chrono::milliseconds timeout) {
  // Twice at most, so that a flood of other senders' packets cannot keep the caller here.
  for (const bool may_wait : {true, false}) {
    if (take_any(packet)) return ReadResult::packet;
    if (fill() || !may_wait) continue;
    if (!wait(timeout)) return ReadResult::timeout;
    fill();
  }
  return take_any(packet) ? ReadResult::packet : ReadResult::timeout;
}

bool TwoPortSource::fill() {
  const std::uint64_t errors_before = receive_errors();
  bool some_came = false;
  for (auto& socket : sockets_) some_came = (socket && socket->fill()) || some_came;
  if (some_came) return true;
  // A socket with an error counts as readable: at real-time priority it would take the whole core.
  if (receive_errors() != errors_before) std::this_thread::sleep_for(kAfterAnError);
  return false;
}

}  // namespace

std::unique_ptr<UdpSource> open_udp(const UdpConfig& config) {
  return std::make_unique<TwoPortSource>(config);
}

}  // namespace lilo
