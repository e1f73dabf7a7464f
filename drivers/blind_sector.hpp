// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/azimuth.hpp"

#include <cstdint>
#include <optional>

namespace lilo {

/// Finds the part of the turn a sensor does not fire in (field of view, set in its web page): it
/// sends no packets there, which looks like loss. Loss wanders, because packets begin at other
/// azimuths every turn; the same gap in kTurns turns one after the other is a blind sector.
///
/// Angles are ticks in the direction of turning, from wherever the caller counts; packets begin and
/// end anywhere, so both ends of the gap may waver by one packet.
class BlindSector {
 public:
  struct Sector {
    double start_ticks = 0.0;  ///< in [0, 36000)
    double width_ticks = 0.0;
  };

  /// A gap between two columns, in which `missing` packets were due. Returns how many of them are
  /// lost, which is all of them while the sector is not known.
  std::uint32_t see_gap(Sector gap, double packet_ticks, std::uint32_t missing);
  /// A column at this angle: what fires there is not blind.
  void see_column(double ticks) {
    if (turns_ > 0 && wrap_ticks(ticks - sector_.start_ticks - margin_ticks_) <
                          sector_.width_ticks - 2.0 * margin_ticks_)
      *this = BlindSector();
  }
  /// Nothing while none is known.
  [[nodiscard]] std::optional<Sector> sector() const {
    return turns_ >= kTurns ? std::optional(sector_) : std::nullopt;
  }
  /// Packets that were counted as lost before the sector was known; 0 when asked again.
  [[nodiscard]] std::uint64_t take_miscounted();

  static constexpr int kTurns = 5;

 private:
  [[nodiscard]] bool is_same(Sector gap) const;
  void widen(Sector gap);

  Sector sector_;
  double margin_ticks_ = 0.0;
  int turns_ = 0;  // how many times in a row it was there
  std::uint64_t miscounted_ = 0;
};

}  // namespace lilo
