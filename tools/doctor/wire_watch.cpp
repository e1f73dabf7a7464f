// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_source.hpp"
#include "drivers/wire.hpp"
#include "tools/clock.hpp"
#include "tools/doctor/wire.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace lilo::doctor {
namespace {

constexpr std::uint64_t kEnough = 100;

/// Packets every card has received, from /proc/net/dev.
std::map<std::string, std::uint64_t> received_by_card() {
  std::map<std::string, std::uint64_t> out;
  std::ifstream file("/proc/net/dev");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::size_t name = line.find_first_not_of(' ');
    std::istringstream numbers(line.substr(colon + 1));
    std::uint64_t bytes = 0, packets = 0;
    numbers >> bytes >> packets;
    out[line.substr(name, colon - name)] = packets;
  }
  return out;
}

void count(const PacketView& packet, std::uint16_t position_port, Wire& wire) {
  Sender& sender = wire.senders[packet.source_ipv4];
  if (const auto identity = identity_of(packet.payload)) {
    ++sender.data;
    sender.identity = *identity;
  } else if (packet.destination_port == position_port) {
    ++sender.position;
  } else {
    ++sender.other;
  }
}

bool enough(const Wire& wire) {
  return std::any_of(wire.senders.begin(), wire.senders.end(),
                     [](const auto& each) { return each.second.data >= kEnough; });
}

void listen(UdpSource& source, const UdpConfig& config, double seconds, Wire& wire) {
  constexpr std::chrono::milliseconds kLook{100};
  const std::int64_t start_ns = monotonic_ns();
  const auto elapsed_s = [&] { return static_cast<double>(monotonic_ns() - start_ns) * 1e-9; };
  PacketView packet;
  // Half a second at least: a second sensor shows itself in that.
  while (elapsed_s() < seconds && (elapsed_s() < 0.5 || !enough(wire))) {
    if (source.read(packet, kLook) == ReadResult::packet) count(packet, config.position_port, wire);
  }
  wire.seconds = elapsed_s();
}

}  // namespace

std::optional<SensorIdentity> identity_of(std::span<const std::byte> payload) {
  if (payload.size() != wire::kDataPacketBytes) return {};
  const DataPacket data = payload.first<wire::kDataPacketBytes>();
  if (wire::block_flag(data.data(), 0) != wire::kUpperFlag) return {};
  return identify(data);
}

Wire watch_wire(const UdpConfig& config, double seconds) {
  Wire wire;
  UdpConfig everybody = config;
  everybody.sensor_address.clear();
  everybody.share_ports = false;  // a port is shared by those who name their sensor
  const auto before = received_by_card();
  try {
    const std::unique_ptr<UdpSource> source = open_udp(everybody);
    listen(*source, config, seconds, wire);
  } catch (const DriverError& error) {
    wire.trouble = error.what();
    wire.port_taken = wire.trouble.find("in use") != std::string::npos;
  }
  for (const auto& [card, packets] : received_by_card()) {
    const auto old = before.find(card);
    wire.card_packets[card] = packets - (old == before.end() ? 0 : old->second);
  }
  return wire;
}

}  // namespace lilo::doctor
