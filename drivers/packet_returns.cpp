// The part of PacketDecoder that runs for every return.
#include "drivers/packet_decoder.hpp"

#include <algorithm>
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
constexpr std::size_t kSmall = 16;  // lasers of a sensor with two cycles a block

LILO_INLINE float square(float v) { return v * v; }

}  // namespace

// `laser`: number of the block's first one, `angle`: where its angles stand. No branches within the
// loop, and nothing the compiler may not compute for several lasers at once.
template <std::size_t kLasers, bool kCorrected>
LILO_INLINE Firing<kLasers> PacketDecoder::project(int block, std::size_t laser,
                                                   std::size_t angle) const {
  const std::byte* bytes = wire::block(packet_, block);
  // A block holds two cycles of a sensor with sixteen lasers.
  const std::size_t first_channel = kLasers == kBank ? 0 : angle;
  const auto raw =
      channels<kLasers>(bytes + wire::kBlockHeaderBytes + first_channel * wire::kChannelBytes);
  const AzimuthTable::Entry base = azimuths_[wire::u16(bytes + 2)];
  const float step_m = lasers_.step_m;
  Firing<kLasers> seen;
  for (std::size_t k = 0; k < kLasers; ++k) {
    const std::size_t i = laser + k;
    const float turn_cos = angles_.cos[angle + k], turn_sin = angles_.sin[angle + k];
    const float cos_a = base.cos * turn_cos - base.sin * turn_sin;
    const float sin_a = base.sin * turn_cos + base.cos * turn_sin;
    const std::int32_t steps = raw[k] & 0xFFFF;
    const float range = static_cast<float>(steps) * step_m;
    if constexpr (kCorrected) {
      const float d = range + lasers_.dist_m[i];
      const float flat_x = lasers_.cos_w[i] * sin_a, flat_y = lasers_.cos_w[i] * cos_a;
      const float side = d * flat_x - lasers_.horizontal_m[i] * cos_a;   // the manual's x
      const float ahead = d * flat_y + lasers_.horizontal_m[i] * sin_a;  // and y
      const float more_x = lasers_.near_x[i] * (kFarM - std::min(std::abs(side), kFarM));
      const float more_y = lasers_.near_y[i] * (kFarM - std::min(std::abs(ahead), kFarM));
      const auto echo = static_cast<float>(raw[k] >> 16);
      const float focus =
          lasers_.slope[i] * std::abs(lasers_.focal[i] - square(1.0F - range / kFocalRangeM));
      const float intensity =
          std::min(std::max(echo + focus, lasers_.min_intensity[i]), lasers_.max_intensity[i]);
      seen.x_m[k] = ahead + more_y * flat_y;
      seen.y_m[k] = -(side + more_x * flat_x);
      seen.z_m[k] = (d + 0.5F * (more_x + more_y)) * lasers_.sin_w[i] + lasers_.vertical_m[i];
      seen.ring_and_intensity[k] = lasers_.ring[i] | static_cast<std::int32_t>(intensity) << 8;
    } else {
      const float horizontal = range * lasers_.cos_w[i];
      seen.x_m[k] = horizontal * cos_a;
      seen.y_m[k] = -horizontal * sin_a;
      seen.z_m[k] = range * lasers_.sin_w[i] + lasers_.vertical_m[i];
      seen.ring_and_intensity[k] = lasers_.ring[i] | raw[k] >> 16 << 8;
    }
    seen.azimuth_rad[k] = base.ccw_rad - angles_.rad[angle + k];
    seen.steps[k] = steps;
    seen.in_range[k] = static_cast<std::int32_t>(steps >= lasers_.min_steps[i]) &
                       static_cast<std::int32_t>(steps <= lasers_.max_steps[i]);
  }
  wrap_around(base.ccw_rad, angles_.largest_rad, seen.azimuth_rad);
  return seen;
}

Firing<16> PacketDecoder::project16(int block, std::size_t laser, std::size_t angle) const {
  return project<16, false>(block, laser, angle);
}
LILO_EIGHT_LANES
Firing<32> PacketDecoder::project32(int block, std::size_t laser, std::size_t angle) const {
  return project<32, false>(block, laser, angle);
}
Firing<16> PacketDecoder::correct16(int block, std::size_t laser, std::size_t angle) const {
  return project<16, true>(block, laser, angle);
}
LILO_EIGHT_LANES
Firing<32> PacketDecoder::correct32(int block, std::size_t laser, std::size_t angle) const {
  return project<32, true>(block, laser, angle);
}

void PacketDecoder::append(std::size_t column, std::int32_t t_ns, Returns& out) const {
  const bool two_cycles = table_->cycles_per_block == 2;  // no division: it runs often
  const int shot = static_cast<int>(two_cycles ? column / 2 : column);
  const int block = shot * layout_.blocks_per_shot;
  const std::size_t angle = two_cycles && column % 2 == 1 ? kSmall : 0;
  if (static_cast<std::size_t>(table_->lasers) == kSmall) {
    lasers_.corrected ? append_with<&PacketDecoder::correct16>(block, angle, t_ns, out)
                      : append_with<&PacketDecoder::project16>(block, angle, t_ns, out);
  } else {
    lasers_.corrected ? append_with<&PacketDecoder::correct32>(block, angle, t_ns, out)
                      : append_with<&PacketDecoder::project32>(block, angle, t_ns, out);
  }
}

template <auto kProject>
void PacketDecoder::append_with(int block, std::size_t angle, std::int32_t t_ns,
                                Returns& out) const {
  if (table_->banks_fire_together) {
    is_dual() ? append_dual_together<kProject>(block, t_ns, out)
              : append_together<kProject>(block, t_ns, out);
  } else {
    is_dual() ? append_dual<kProject>(block, angle, t_ns, out)
              : append_single<kProject>(block, angle, t_ns, out);
  }
}

template <auto kProject>
void PacketDecoder::append_single(int block, std::size_t angle, std::int32_t t_ns,
                                  Returns& out) const {
  const ReturnKind kind =
      layout_.mode == ReturnMode::last ? ReturnKind::last : ReturnKind::strongest;
  const std::int32_t* laser_ns = times_->laser_ns.data();
  Kept kept(out, static_cast<std::size_t>(table_->lasers));
  for (int bank = 0; bank < table_->banks; ++bank, ++block, angle += kBank, laser_ns += kBank) {
    const std::size_t laser = static_cast<std::size_t>(bank) * kBank;
    const auto seen = (this->*kProject)(block, laser, angle);
    for (std::size_t k = 0; k < seen.size(); ++k)
      kept.add(seen, k, t_ns + laser_ns[k], kind, seen.in_range[k]);
  }
}

// Upper and lower laser of one number fire together, so they alternate in the scan.
template <auto kProject>
void PacketDecoder::append_together(int block, std::int32_t t_ns, Returns& out) const {
  const ReturnKind kind = ReturnKind::strongest;
  const auto upper = (this->*kProject)(block, 0, 0);
  const auto lower = (this->*kProject)(block + 1, kBank, kBank);
  const std::int32_t* laser_ns = times_->laser_ns.data();
  Kept kept(out, 2 * kBank);
  for (std::size_t k = 0; k < upper.size(); ++k) {
    const std::int32_t at_ns = t_ns + laser_ns[k];
    kept.add(upper, k, at_ns, kind, upper.in_range[k]);
    kept.add(lower, k, at_ns, kind, lower.in_range[k]);
  }
}

// Equal ones are one echo. See EchoOrder.
template <auto kProject>
void PacketDecoder::append_dual(int block, std::size_t angle, std::int32_t t_ns,
                                Returns& out) const {
  const std::int32_t* laser_ns = times_->laser_ns.data();
  Kept kept(out, static_cast<std::size_t>(table_->lasers) * 2);
  for (int bank = 0; bank < table_->banks;
       ++bank, block += layout_.bank_stride, angle += kBank, laser_ns += kBank) {
    const std::size_t laser = static_cast<std::size_t>(bank) * kBank;
    const auto last = (this->*kProject)(block, laser, angle);
    const auto other = (this->*kProject)(block + 1, laser, angle);
    for (std::size_t k = 0; k < last.size(); ++k) {
      const bool same = last.steps[k] == other.steps[k];
      const bool last_is_strongest = last.intensity(k) > other.intensity(k);
      const bool want_last = same || choice_ != ReturnChoice::strongest || last_is_strongest;
      const bool want_other = !same && (choice_ == ReturnChoice::both ||
                                        (choice_ == ReturnChoice::strongest && !want_last));
      const std::int32_t at_ns = t_ns + laser_ns[k];
      kept.add(last, k, at_ns, same ? ReturnKind::both : ReturnKind::last,
               want_last ? last.in_range[k] : 0);
      kept.add(other, k, at_ns, ReturnKind::strongest, want_other ? other.in_range[k] : 0);
    }
  }
}

template <auto kProject>
void PacketDecoder::append_dual_together(int block, std::int32_t t_ns, Returns& out) const {
  const std::array first{(this->*kProject)(block, 0, 0),
                         (this->*kProject)(block + 1, kBank, kBank)};
  const std::array second{(this->*kProject)(block + 2, 0, 0),
                          (this->*kProject)(block + 3, kBank, kBank)};
  const std::int32_t* laser_ns = times_->laser_ns.data();
  Kept kept(out, 4 * kBank);
  for (std::size_t k = 0; k < first[0].size(); ++k) {
    const std::int32_t at_ns = t_ns + laser_ns[k];
    for (std::size_t bank = 0; bank < 2; ++bank) {
      const bool same = first[bank].steps[k] == second[bank].steps[k];
      const bool want_first = same || choice_ != ReturnChoice::last;
      const bool want_second = !same && choice_ != ReturnChoice::strongest;
      kept.add(first[bank], k, at_ns, same ? ReturnKind::both : ReturnKind::strongest,
               want_first ? first[bank].in_range[k] : 0);
      kept.add(second[bank], k, at_ns, ReturnKind::last,
               want_second ? second[bank].in_range[k] : 0);
    }
  }
}

}  // namespace lilo
