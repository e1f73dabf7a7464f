// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_returns.hpp"

#include "drivers/firing.hpp"
#include "drivers/wire.hpp"

#include <algorithm>
#include <array>
#include <cmath>

// Debian is compiled for processors that take four lasers at a time. Where one takes eight, a
// second version is called; it rounds as the first does, so the returns are the same bits. A
// program under ThreadSanitizer crashes when it chooses between the two.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define LILO_EIGHT_LANES __attribute__((target_clones("avx2", "default")))
#else
#define LILO_EIGHT_LANES
#endif
#define LILO_INLINE [[gnu::always_inline]] inline

namespace lilo {
namespace {

constexpr std::size_t kBank = wire::kChannelsPerBlock;
constexpr std::size_t kSmall = 16;  // lasers of a sensor with two cycles a block and one bank

LILO_INLINE float square(float v) { return v * v; }

// `laser`: number of the block's first one, `angle`: where its angles stand. No branches within the
// loop, and nothing the compiler may not compute for several lasers at once.
template <std::size_t kLasers, bool kCorrected>
LILO_INLINE Firing<kLasers> project(const PacketContents& packet, int block, std::size_t laser,
                                    std::size_t angle) {
  const std::byte* bytes = wire::block(packet.bytes, block);
  const Lasers& lasers = packet.lasers;
  const LaserAngles& angles = packet.angles;
  // A block holds two cycles of a sensor with sixteen lasers.
  const std::size_t first_channel = kLasers == kBank ? 0 : angle;
  const auto raw =
      channels<kLasers>(bytes + wire::kBlockHeaderBytes + first_channel * wire::kChannelBytes);
  const AzimuthTable::Entry base = (*packet.azimuths)[wire::u16(bytes + 2)];
  const float step_m = lasers.step_m;
  Firing<kLasers> seen;
  for (std::size_t k = 0; k < kLasers; ++k) {
    const std::size_t i = laser + k;
    const float turn_cos = angles.cos[angle + k], turn_sin = angles.sin[angle + k];
    const float cos_a = base.cos * turn_cos - base.sin * turn_sin;
    const float sin_a = base.sin * turn_cos + base.cos * turn_sin;
    const std::int32_t steps = raw[k] & 0xFFFF;
    const float range = static_cast<float>(steps) * step_m;
    if constexpr (kCorrected) {
      const float d = range + lasers.dist_m[i];
      const float flat_x = lasers.cos_w[i] * sin_a, flat_y = lasers.cos_w[i] * cos_a;
      const float side = d * flat_x - lasers.horizontal_m[i] * cos_a;   // the manual's x
      const float ahead = d * flat_y + lasers.horizontal_m[i] * sin_a;  // and y
      const float more_x = lasers.near_x[i] * (kFarM - std::min(std::abs(side), kFarM));
      const float more_y = lasers.near_y[i] * (kFarM - std::min(std::abs(ahead), kFarM));
      const auto echo = static_cast<float>(raw[k] >> 16);
      const float focus =
          lasers.slope[i] * std::abs(lasers.focal[i] - square(1.0F - range / kFocalRangeM));
      const float intensity =
          std::min(std::max(echo + focus, lasers.min_intensity[i]), lasers.max_intensity[i]);
      seen.x_m[k] = ahead + more_y * flat_y;
      seen.y_m[k] = -(side + more_x * flat_x);
      seen.z_m[k] = (d + 0.5F * (more_x + more_y)) * lasers.sin_w[i] + lasers.vertical_m[i];
      seen.ring_and_intensity[k] = lasers.ring[i] | static_cast<std::int32_t>(intensity) << 8;
    } else {
      const float horizontal = range * lasers.cos_w[i];
      seen.x_m[k] = horizontal * cos_a;
      seen.y_m[k] = -horizontal * sin_a;
      seen.z_m[k] = range * lasers.sin_w[i] + lasers.vertical_m[i];
      seen.ring_and_intensity[k] = lasers.ring[i] | raw[k] >> 16 << 8;
    }
    seen.azimuth_rad[k] = base.ccw_rad - angles.rad[angle + k];
    seen.steps[k] = steps;
    seen.in_range[k] = static_cast<std::int32_t>(steps >= lasers.min_steps[i]) &
                       static_cast<std::int32_t>(steps <= lasers.max_steps[i]);
  }
  wrap_around(base.ccw_rad, angles.largest_rad, seen.azimuth_rad);
  return seen;
}

Firing<16> project16(const PacketContents& packet, int block, std::size_t laser,
                     std::size_t angle) {
  return project<16, false>(packet, block, laser, angle);
}
LILO_EIGHT_LANES
Firing<32> project32(const PacketContents& packet, int block, std::size_t laser,
                     std::size_t angle) {
  return project<32, false>(packet, block, laser, angle);
}
Firing<16> correct16(const PacketContents& packet, int block, std::size_t laser,
                     std::size_t angle) {
  return project<16, true>(packet, block, laser, angle);
}
LILO_EIGHT_LANES
Firing<32> correct32(const PacketContents& packet, int block, std::size_t laser,
                     std::size_t angle) {
  return project<32, true>(packet, block, laser, angle);
}

template <auto kProject>
constexpr std::size_t kLasersOf = decltype(kProject({}, 0, 0, 0))::size();

// A constant where there is one bank, so that no loop over banks is left.
template <auto kProject>
LILO_INLINE int banks_of(const PacketContents& packet) {
  return kLasersOf<kProject> == kSmall ? 1 : packet.table->banks;
}

template <auto kProject>
void append_single(const PacketContents& packet, int block, std::size_t angle, std::int32_t t_ns,
                   Returns& out) {
  const ReturnKind kind =
      packet.layout.mode == ReturnMode::last ? ReturnKind::last : ReturnKind::strongest;
  const std::int32_t* laser_ns = packet.times->laser_ns.data();
  const int banks = banks_of<kProject>(packet);
  Kept kept(out, static_cast<std::size_t>(banks) * kLasersOf<kProject>);
  for (int bank = 0; bank < banks; ++bank, ++block, angle += kBank, laser_ns += kBank) {
    const std::size_t laser = static_cast<std::size_t>(bank) * kBank;
    const auto seen = kProject(packet, block, laser, angle);
    for (std::size_t k = 0; k < seen.size(); ++k)
      kept.add(seen, k, t_ns + laser_ns[k], kind, seen.in_range[k]);
  }
}

// Upper and lower laser of one number fire together, so they alternate in the scan.
template <auto kProject>
void append_together(const PacketContents& packet, int block, std::int32_t t_ns, Returns& out) {
  const ReturnKind kind = ReturnKind::strongest;
  const auto upper = kProject(packet, block, 0, 0);
  const auto lower = kProject(packet, block + 1, kBank, kBank);
  const std::int32_t* laser_ns = packet.times->laser_ns.data();
  Kept kept(out, 2 * kBank);
  for (std::size_t k = 0; k < upper.size(); ++k) {
    const std::int32_t at_ns = t_ns + laser_ns[k];
    kept.add(upper, k, at_ns, kind, upper.in_range[k]);
    kept.add(lower, k, at_ns, kind, lower.in_range[k]);
  }
}

// Equal ones are one echo. See EchoOrder.
template <auto kProject>
void append_dual(const PacketContents& packet, int block, std::size_t angle, std::int32_t t_ns,
                 Returns& out) {
  const std::int32_t* laser_ns = packet.times->laser_ns.data();
  const int banks = banks_of<kProject>(packet);
  Kept kept(out, static_cast<std::size_t>(banks) * kLasersOf<kProject> * 2);
  for (int bank = 0; bank < banks;
       ++bank, block += packet.layout.bank_stride, angle += kBank, laser_ns += kBank) {
    const std::size_t laser = static_cast<std::size_t>(bank) * kBank;
    const auto last = kProject(packet, block, laser, angle);
    const auto other = kProject(packet, block + 1, laser, angle);
    for (std::size_t k = 0; k < last.size(); ++k) {
      const bool same = last.steps[k] == other.steps[k];
      const bool last_is_strongest = last.intensity(k) > other.intensity(k);
      const bool want_last = same || packet.choice != ReturnChoice::strongest || last_is_strongest;
      const bool want_other = !same && (packet.choice == ReturnChoice::both ||
                                        (packet.choice == ReturnChoice::strongest && !want_last));
      const std::int32_t at_ns = t_ns + laser_ns[k];
      kept.add(last, k, at_ns, same ? ReturnKind::both : ReturnKind::last,
               want_last ? last.in_range[k] : 0);
      kept.add(other, k, at_ns, ReturnKind::strongest, want_other ? other.in_range[k] : 0);
    }
  }
}

template <auto kProject>
void append_dual_together(const PacketContents& packet, int block, std::int32_t t_ns,
                          Returns& out) {
  const std::array first{kProject(packet, block, 0, 0), kProject(packet, block + 1, kBank, kBank)};
  const std::array second{kProject(packet, block + 2, 0, 0),
                          kProject(packet, block + 3, kBank, kBank)};
  const std::int32_t* laser_ns = packet.times->laser_ns.data();
  Kept kept(out, 4 * kBank);
  for (std::size_t k = 0; k < first[0].size(); ++k) {
    const std::int32_t at_ns = t_ns + laser_ns[k];
    for (std::size_t bank = 0; bank < 2; ++bank) {
      const bool same = first[bank].steps[k] == second[bank].steps[k];
      const bool want_first = same || packet.choice != ReturnChoice::last;
      const bool want_second = !same && packet.choice != ReturnChoice::strongest;
      kept.add(first[bank], k, at_ns, same ? ReturnKind::both : ReturnKind::strongest,
               want_first ? first[bank].in_range[k] : 0);
      kept.add(second[bank], k, at_ns, ReturnKind::last,
               want_second ? second[bank].in_range[k] : 0);
    }
  }
}

template <auto kProject>
void append_with(const PacketContents& packet, int block, std::size_t angle, std::int32_t t_ns,
                 Returns& out) {
  if (packet.table->banks_fire_together) {
    packet.layout.is_dual() ? append_dual_together<kProject>(packet, block, t_ns, out)
                            : append_together<kProject>(packet, block, t_ns, out);
  } else {
    packet.layout.is_dual() ? append_dual<kProject>(packet, block, angle, t_ns, out)
                            : append_single<kProject>(packet, block, angle, t_ns, out);
  }
}

}  // namespace

void append_column(const PacketContents& packet, std::size_t column, std::int32_t t_ns,
                   Returns& out) {
  const bool two_cycles = packet.table->cycles_per_block == 2;  // no division: it runs often
  const int shot = static_cast<int>(two_cycles ? column / 2 : column);
  const int block = shot * packet.layout.blocks_per_shot;
  const std::size_t angle = two_cycles && column % 2 == 1 ? kSmall : 0;
  if (static_cast<std::size_t>(packet.table->lasers) == kSmall) {
    packet.lasers.corrected ? append_with<correct16>(packet, block, angle, t_ns, out)
                            : append_with<project16>(packet, block, angle, t_ns, out);
  } else {
    packet.lasers.corrected ? append_with<correct32>(packet, block, angle, t_ns, out)
                            : append_with<project32>(packet, block, angle, t_ns, out);
  }
}

}  // namespace lilo
