// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/faults.hpp"

#include <algorithm>
#include <utility>

namespace lilo::sim {

Faults::Faults(const FaultOptions& options, std::uint64_t seed, Deliver deliver)
    : options_(options), random_(seed, 80), deliver_(std::move(deliver)) {}

bool Faults::is_silent(std::int64_t time_ns) const {
  if (options_.restart_at_s < 0.0) return false;
  const double time_s = static_cast<double>(time_ns) * 1e-9;
  return time_s >= options_.restart_at_s && time_s < options_.restart_at_s + options_.restart_gap_s;
}

bool Faults::is_lost(const Packet& packet) {
  const double since_s =
      static_cast<double>(packet.sent_ns - std::exchange(last_ns_, packet.sent_ns)) * 1e-9;
  if (burst_left_ == 0 && random_.chance(options_.bursts_per_minute / 60.0 * since_s)) {
    burst_left_ = options_.burst_packets;
  }
  const bool unlucky = random_.chance(options_.loss);
  if (is_silent(packet.sent_ns)) return true;
  if (burst_left_ > 0) {
    --burst_left_;
    return true;
  }
  return unlucky;
}

Packet Faults::make_garbage(const Packet& model) {
  Packet garbage = model;
  auto& bytes = garbage.payload;
  switch (random_.below(7)) {
    case 0:
      bytes.resize(1205);
      break;
    case 1:
      bytes.push_back(0);
      break;
    case 2:
      bytes.clear();
      break;
    case 3:
      bytes[700] ^= 0x55U;
      break;  // a wrong flag in block 7
    case 4:
      put_u16(bytes, 302, 36000U + static_cast<std::uint32_t>(random_.below(29536)));
      break;
    case 5:
      bytes.assign(512, 0);
      break;  // a position packet's size on the data port
    default:
      bytes.resize(static_cast<std::size_t>(random_.below(1473)));
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random_.next() & 0xFFU);
      // Chance must not make a good packet of it.
      if (bytes.size() == 1206) bytes[0] = 0;
  }
  return garbage;
}

void Faults::send(Packet packet) {
  const bool data = packet.port == kDataPort;
  if (data && random_.chance(options_.garbage)) {
    ++counts_.garbage;
    deliver_(make_garbage(packet));
  }
  if (data && is_lost(packet)) {
    ++counts_.lost;
    lost_ns_.push_back(packet.sent_ns);
    return;
  }
  if (!data && is_silent(packet.sent_ns)) return;
  if (data && !late_ && random_.chance(options_.reorder)) {
    late_ = std::move(packet);
    return;
  }
  deliver_(packet);
  if (data && random_.chance(options_.duplicates)) {
    ++counts_.duplicates;
    deliver_(packet);
  }
  if (data && late_) {
    ++counts_.reordered;
    deliver_(*late_);
    late_.reset();
  }
}

void Faults::flush() {
  if (late_) deliver_(*std::exchange(late_, std::nullopt));
}

}  // namespace lilo::sim
