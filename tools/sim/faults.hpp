// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/options.hpp"
#include "tools/sim/packet.hpp"
#include "tools/sim/random.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace lilo::sim {

struct FaultCounts {
  std::uint64_t lost = 0;        ///< data packets that never arrive, restart silence included
  std::uint64_t duplicates = 0;  ///< packets that arrive twice
  std::uint64_t reordered = 0;   ///< packets that arrive after the one sent after them
  std::uint64_t garbage = 0;     ///< datagrams that are not from a Velodyne or are damaged
};

/// The network between sensor and computer: loses, doubles, swaps and invents packets.
class Faults {
 public:
  using Deliver = std::function<void(const Packet&)>;

  Faults(const FaultOptions& options, std::uint64_t seed, Deliver deliver);

  /// Takes the packets in the order they were sent and delivers what arrives.
  void send(Packet packet);
  /// Delivers what is still under way.
  void flush();

  /// True while a restarting sensor is silent.
  [[nodiscard]] bool is_silent(std::int64_t time_ns) const;
  [[nodiscard]] const FaultCounts& counts() const { return counts_; }
  /// When lost data packets were sent, ns after the recording's start.
  [[nodiscard]] const std::vector<std::int64_t>& lost_ns() const { return lost_ns_; }

 private:
  [[nodiscard]] bool is_lost(const Packet& packet);
  [[nodiscard]] Packet make_garbage(const Packet& model);

  FaultOptions options_;
  Random random_;
  Deliver deliver_;
  std::optional<Packet> late_;  ///< waits until the next one has passed
  int burst_left_ = 0;
  std::int64_t last_ns_ = 0;
  FaultCounts counts_;
  std::vector<std::int64_t> lost_ns_;
};

}  // namespace lilo::sim
