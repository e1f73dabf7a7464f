// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/feature.hpp"
#include "core/map/local_maps.hpp"
#include "core/motion/scan_timing.hpp"
#include "core/scan.hpp"

#include <vector>

namespace lilo::core {

/// What the tracker uses of one scan.
struct Observation {
  ScanTiming timing;
  const std::vector<Feature>* features = nullptr;  ///< those selected for alignment
  double structure = 0.0;                          ///< how many of them are structure
  bool is_room = false;  ///< more than half of the structure is near, as in rooms
  /// Of the map. In rooms the smallest known cell decides. A larger one takes seats and tables for
  /// rough ground, and as the sensor sees other parts of them it rises.
  Levels levels = Levels::from_whole;
  bool is_complete = false;  ///< Scan::complete

  [[nodiscard]] bool says_enough() const { return features->size() >= tracking::kMinFeatures; }
};

/// `selected` must outlive the result.
Observation observe(const Scan& scan, const std::vector<Feature>& selected);

}  // namespace lilo::core
