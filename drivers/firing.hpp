// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/wire.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilo {

/// Of a processor's cache. An array that begins with one is read without crossing lines.
inline constexpr std::size_t kLineBytes = 64;

/// What some lasers of a block saw one after another. An array for each value, so that the compiler
/// takes several lasers at a time.
template <std::size_t kLasers>
struct alignas(kLineBytes) Firing {
  std::array<std::int32_t, kLasers> steps;     ///< distance as sent
  std::array<std::int32_t, kLasers> in_range;  ///< 1 or 0
  std::array<float, kLasers> x_m, y_m, z_m, azimuth_rad;
  std::array<std::int32_t, kLasers> ring_and_intensity;  ///< from the lowest byte on

  [[nodiscard]] static constexpr std::size_t size() { return kLasers; }
  [[nodiscard]] int intensity(std::size_t laser) const { return ring_and_intensity[laser] >> 8; }

  /// Into its place, member by member: a whole Return would be built elsewhere and copied.
  void write(std::size_t laser, std::int32_t t_ns, ReturnKind kind, Return& r) const {
    r.x_m = x_m[laser];
    r.y_m = y_m[laser];
    r.z_m = z_m[laser];
    r.azimuth_rad = azimuth_rad[laser];
    r.t_ns = t_ns;
    r.ring = static_cast<std::uint8_t>(ring_and_intensity[laser]);
    r.intensity = static_cast<std::uint8_t>(ring_and_intensity[laser] >> 8);
    r.kind = kind;
    r.reserved = 0;
  }
};

/// The channels of a block as sent: distance in the lower two bytes, intensity above.
template <std::size_t kLasers>
std::array<std::int32_t, kLasers> channels(const std::byte* first) {
  std::array<std::int32_t, kLasers> raw;
  // A channel has three bytes; behind the last one of a packet lies the stamp.
  for (std::size_t k = 0; k < kLasers; ++k) {
    raw[k] = static_cast<std::int32_t>(wire::u32(first + k * wire::kChannelBytes) & 0xFFFFFFU);
  }
  return raw;
}

/// Returns of a column, written at the end of a scan and counted only if wanted, without a branch.
/// The scan must have room for `most`, or it allocates.
class Kept {
 public:
  Kept(Returns& out, std::size_t most) : out_(out) {
    const std::size_t before = out.size();
    out.resize(before + most);
    next_ = out.data() + before;
  }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  ~Kept() { out_.resize(static_cast<std::size_t>(next_ - out_.data())); }

  /// `wanted`: 1 or 0.
  template <std::size_t kLasers>
  void add(const Firing<kLasers>& seen, std::size_t laser, std::int32_t t_ns, ReturnKind kind,
           std::int32_t wanted) {
    seen.write(laser, t_ns, kind, *next_);
    next_ += wanted;
  }

 private:
  Returns& out_;
  Return* next_;
};

}  // namespace lilo
