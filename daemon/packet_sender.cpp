// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_sender.hpp"

#include <chrono>
#include <utility>

namespace lilo {
namespace {

// 19 200 packets a second: more than any sensor sends, and the most that a flood can cost us.
constexpr std::chrono::milliseconds kPeriod{5};
constexpr int kMostAtOnce = 96;

}  // namespace

PacketSender::PacketSender(boost::asio::io_context& io, Engine& engine, Server& server,
                           std::function<void()> send_poses)
    : engine_(engine), server_(server), send_poses_(std::move(send_poses)), timer_(io) {}

void PacketSender::start() {
  if (running_) return;
  running_ = true;
  // What the receiver was still writing when the last client went.
  for (PacketRing& ring = engine_.packets(); ring.front() != nullptr;) ring.release();
  engine_.want_packets(true);
  await_look();
}

void PacketSender::await_look() {
  timer_.expires_after(kPeriod);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) look();
  });
}

void PacketSender::look() {
  running_ = server_.has_packets_clients();
  engine_.want_packets(running_);
  if (!running_) return;
  PacketRing& ring = engine_.packets();
  for (int k = 0; k < kMostAtOnce; ++k) {
    send_poses_();
    const PacketDatagram* const packet = ring.front();
    if (packet == nullptr) break;
    server_.send_packet(packet->view());
    ring.release();
  }
  await_look();
}

}  // namespace lilo
