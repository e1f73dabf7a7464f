// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/packet_recording.hpp"

#include "daemon/packet_message.hpp"

#include <fmt/format.h>

namespace lilo {
namespace {

constexpr std::uint32_t kBroadcast = 0xFFFFFFFF;
constexpr std::uint64_t kMostOvertakenBy = 32;

}  // namespace

PacketRecording::PacketRecording(const std::string& path) : file_(path, /*nanoseconds=*/true) {}

void PacketRecording::take(std::string_view datagram) {
  const auto message = read_packet(datagram);
  if (!message) return;
  const PacketView& packet = message->packet;
  file_.write({.source_ipv4 = packet.source_ipv4,
               .destination_ipv4 = kBroadcast,
               .source_port = packet.source_port,
               .destination_port = packet.destination_port},
              packet.payload, packet.received_ns);
  count(message->seq);
}

// A number that was passed by is that of a packet overtaken on the way, and had been missed; one
// far back is that of a daemon that has started again.
void PacketRecording::count(std::uint64_t seq) {
  ++packets_;
  const std::uint64_t next = next_seq_.value_or(seq);
  const bool overtaken = seq < next && next - seq <= kMostOvertakenBy;
  if (overtaken) {
    missed_ -= missed_ > 0 ? 1 : 0;
    return;
  }
  if (seq > next) missed_ += seq - next;
  next_seq_ = seq + 1;
}

std::string to_text(const PacketRecording& packets) {
  if (packets.missed() == 0) return fmt::format("{} packets, none missed", packets.packets());
  return fmt::format("{} packets, {} missed: a larger net.core.rmem_max or a faster disk helps",
                     packets.packets(), packets.missed());
}

}  // namespace lilo
