// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/blind_sector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lilo {
namespace {

constexpr double kTurn = wire::kTicksPerTurn;
constexpr double kMinPackets = 3.0;     // a smaller gap is nobody's choice
constexpr double kMarginPackets = 1.2;  // each end of a gap wavers by a packet and some noise

double between(double from, double to) { return std::remainder(to - from, kTurn); }

}  // namespace

bool BlindSector::is_same(Sector gap) const {
  const double start = between(sector_.start_ticks, gap.start_ticks);
  const double end = start + gap.width_ticks - sector_.width_ticks;
  return std::abs(start) < margin_ticks_ && std::abs(end) < margin_ticks_;
}

// All turns' gaps together: what a packet could have told of is inside for certain.
void BlindSector::widen(Sector gap) {
  const double earlier = std::max(0.0, -between(sector_.start_ticks, gap.start_ticks));
  const double start = between(sector_.start_ticks, gap.start_ticks);
  const double end = std::max(sector_.width_ticks, start + gap.width_ticks);
  sector_ = {wrap_ticks(sector_.start_ticks - earlier), end + earlier};
}

std::uint32_t BlindSector::see_gap(Sector gap, double packet_ticks, std::uint32_t missing) {
  if (gap.width_ticks < kMinPackets * packet_ticks || gap.width_ticks >= kTurn - packet_ticks)
    return missing;
  margin_ticks_ = kMarginPackets * packet_ticks;
  if (turns_ >= kTurns) {
    const double from_start = between(sector_.start_ticks, gap.start_ticks);
    const double past_end = from_start + gap.width_ticks - sector_.width_ticks;
    // Only a gap that holds the sector has something to do with it.
    if (from_start > margin_ticks_ || past_end < -margin_ticks_) return missing;
    const double beyond = std::max(0.0, -from_start) + std::max(0.0, past_end);
    // Whole packets make the gap waver by less than one of them, at both ends together.
    const auto lost = static_cast<std::uint32_t>(beyond / packet_ticks + 0.25);
    if (lost == 0) widen(gap);
    return std::min(missing, lost);
  }
  if (turns_ > 0 && is_same(gap)) {
    widen(gap);
  } else {
    turns_ = 0;
    miscounted_ = 0;
    sector_ = gap;
  }
  ++turns_;
  miscounted_ += missing;
  if (turns_ < kTurns) return missing;
  miscounted_ -= missing;  // these are not counted in the first place
  return 0;
}

std::uint64_t BlindSector::take_miscounted() {
  return turns_ >= kTurns ? std::exchange(miscounted_, 0U) : 0U;
}

}  // namespace lilo
