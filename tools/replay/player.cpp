// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/player.hpp"

#include "drivers/wire.hpp"
#include "tools/clock.hpp"

#include <boost/asio/buffer.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace lilo {
namespace {

using boost::asio::ip::udp;

constexpr std::int64_t kSlice_ns = 100'000'000;

udp::endpoint resolve(boost::asio::io_context& io, const std::string& host) {
  boost::system::error_code error;
  const auto found = udp::resolver(io).resolve(udp::v4(), host, "", error);
  if (error || found.empty()) {
    throw std::runtime_error(
        fmt::format("{}: expected the name or IPv4 address of a host: {}", host, error.message()));
  }
  return found.begin()->endpoint();
}

}  // namespace

Player::Player(const ReplayOptions& options)
    : options_(options),
      destination_(resolve(io_, options.host)),
      socket_(io_, udp::v4()),
      start_ns_(monotonic_ns()),
      pacer_(options.speed, start_ns_) {
  socket_.set_option(boost::asio::socket_base::broadcast(true));
}

bool Player::play(PacketSource& source, const std::function<bool(const ReplayCounts&)>& go_on) {
  pacer_.restart();
  PacketView packet;
  while (source.read(packet, std::chrono::milliseconds(0)) == ReadResult::packet) {
    const std::int64_t due_ns = pacer_.due_ns(packet.received_ns);
    if (!wait_until(due_ns, go_on)) return false;
    send(packet);
    const std::int64_t now_ns = monotonic_ns();
    counts_.latest_ns = std::max(counts_.latest_ns, now_ns - due_ns);
    counts_.elapsed_ns = now_ns - start_ns_;
  }
  return true;
}

bool Player::wait_until(std::int64_t due_ns,
                        const std::function<bool(const ReplayCounts&)>& go_on) {
  do {
    if (!go_on(counts_)) return false;
    sleep_until(std::min(due_ns, monotonic_ns() + kSlice_ns));
  } while (monotonic_ns() < due_ns);
  return true;
}

void Player::send(const PacketView& packet) {
  destination_.port(port_for(packet));
  boost::system::error_code error;
  const auto payload = boost::asio::buffer(packet.payload.data(), packet.payload.size());
  counts_.bytes += socket_.send_to(payload, destination_, 0, error);
  if (error) {
    throw std::runtime_error(fmt::format("cannot send to {}:{}: {}", options_.host,
                                         destination_.port(), error.message()));
  }
  ++counts_.packets;
}

std::uint16_t Player::port_for(const PacketView& packet) const {
  const bool position = packet.destination_port == wire::kPositionPort;
  const std::uint16_t asked = position ? options_.position_port : options_.data_port;
  return asked != 0 ? asked : packet.destination_port;
}

}  // namespace lilo
