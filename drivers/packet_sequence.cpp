// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>

namespace lilo {
namespace {

// A silence beyond this is checked against the computer's clock: if that saw as much time pass,
// packets were lost; if not, the sensor's clock jumped.
constexpr std::int64_t kSuspiciousNs = 1'000'000'000;

}  // namespace

void PacketSequence::remember(std::int64_t stamp_ns) {
  seen_[seen_count_ % kMemory] = stamp_ns;
  ++seen_count_;
}

PacketSequence::Verdict PacketSequence::start_over(std::int64_t stamp_ns, std::int64_t received_ns,
                                                   Arrival arrival) {
  started_ = true;
  newest_ns_ = stamp_ns;
  received_ns_ = received_ns;
  inner_gap_ns_ = 0;
  seen_count_ = 0;
  remember(stamp_ns);
  return {arrival, 0};
}

PacketSequence::Verdict PacketSequence::see(std::int64_t stamp_ns, std::int64_t received_ns,
                                            double period_ns, std::int64_t inner_gap_ns) {
  if (!started_) return start_over(stamp_ns, received_ns, Arrival::first);
  const std::int64_t step_ns = stamp_ns - newest_ns_;
  if (step_ns > 0) {
    const std::int64_t received_step_ns = received_ns - received_ns_;
    if (step_ns > kSuspiciousNs && std::abs(step_ns - received_step_ns) > kSuspiciousNs)
      return start_over(stamp_ns, received_ns, Arrival::restart);
    const auto periods = std::llround(static_cast<double>(step_ns - inner_gap_ns_) / period_ns);
    inner_gap_ns_ = inner_gap_ns;
    newest_ns_ = stamp_ns;
    received_ns_ = received_ns;
    remember(stamp_ns);
    return {Arrival::next, static_cast<std::uint32_t>(std::clamp(periods - 1, 0LL, 0xFFFFFFFFLL))};
  }
  const std::span recent(seen_.data(), std::min(seen_count_, kMemory));
  if (std::find(recent.begin(), recent.end(), stamp_ns) != recent.end())
    return {Arrival::duplicate, 0};
  if (static_cast<double>(-step_ns) < period_ns * static_cast<double>(kMemory)) {
    remember(stamp_ns);
    return {Arrival::late, 0};
  }
  return start_over(stamp_ns, received_ns, Arrival::restart);
}

}  // namespace lilo
