// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/wire.hpp"

#include <bitset>
#include <cstddef>

namespace lilo {

/// Which part of a revolution packets have told of, in bins of 0.5 degree counted from the cut. A
/// column is wider than none of its neighbours' gaps up to 1500 rpm, so an empty bin is a hole.
/// The order of arrival does not matter: a late packet closes the hole that its absence made.
class Coverage {
 public:
  struct Hole {
    double start_ticks = 0.0;  ///< after the cut, in the direction of turning
    double width_ticks = 0.0;
  };

  /// `phase_ticks` after the cut, in [0, 36000).
  void mark(double phase_ticks) {
    bins_.set(static_cast<std::size_t>(phase_ticks / kTicksPerBin) % kBins);
  }
  void clear() { bins_.reset(); }

  [[nodiscard]] double covered_ticks() const {
    return static_cast<double>(bins_.count()) * kTicksPerBin;
  }
  [[nodiscard]] Hole largest_hole() const;

  static constexpr double kTicksPerBin = 50.0;
  static constexpr std::size_t kBins = 720;

 private:
  std::bitset<kBins> bins_;
};

}  // namespace lilo
