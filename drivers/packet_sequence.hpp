// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lilo {

/// Tells from the sensor's own stamps what became of the packets between two arrivals. Stamps are
/// exact to a microsecond and packets leave at a fixed period, so every loss is countable.
class PacketSequence {
 public:
  enum class Arrival : std::uint8_t {
    first,      ///< nothing to compare with
    next,       ///< newer than all before; `lost` packets are missing in between
    duplicate,  ///< seen before
    late,       ///< overtaken by a later one; it had been counted as lost
    restart,    ///< the sensor's clock jumped: it was restarted, or its clock was set
  };
  struct Verdict {
    Arrival arrival = Arrival::first;
    std::uint32_t lost = 0;
  };

  /// `stamp_ns` on a time line without hour wraps, `received_ns` by the computer's clock. The
  /// packet after this one is due `period_ns + inner_gap_ns` later.
  Verdict see(std::int64_t stamp_ns, std::int64_t received_ns, double period_ns,
              std::int64_t inner_gap_ns = 0);

  /// Forgets what was before this packet.
  void restart_at(std::int64_t stamp_ns, std::int64_t received_ns) {
    start_over(stamp_ns, received_ns, Arrival::first);
  }

  static constexpr std::size_t kMemory = 64;  ///< how many packets back a late one is recognised

 private:
  void remember(std::int64_t stamp_ns);
  Verdict start_over(std::int64_t stamp_ns, std::int64_t received_ns, Arrival arrival);

  bool started_ = false;
  std::int64_t newest_ns_ = 0;
  std::int64_t received_ns_ = 0;
  std::int64_t inner_gap_ns_ = 0;  // of the newest
  std::array<std::int64_t, kMemory> seen_{};
  std::size_t seen_count_ = 0;
};

}  // namespace lilo
