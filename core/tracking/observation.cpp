// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/observation.hpp"

#include "core/constants.hpp"

#include <algorithm>

namespace lilo::core {
namespace {

/// More than half of the structure is near, as in rooms.
bool is_room(const std::vector<Feature>& features) {
  int near = 0, all = 0;
  for (const Feature& f : features) {
    if (f.kind == FeatureKind::ground) continue;
    ++all;
    near += static_cast<int>(f.x_m * f.x_m + f.y_m * f.y_m + f.z_m * f.z_m <
                             tracking::kRoom_m * tracking::kRoom_m);
  }
  return 2 * near > all;
}

}  // namespace

Observation observe(const Scan& scan, const std::vector<Feature>& selected) {
  const auto structure = std::count_if(selected.begin(), selected.end(), [](const Feature& f) {
    return f.kind == FeatureKind::structure;
  });
  const bool in_room = is_room(selected);
  return {.timing = {scan.start_ns, scan.end_ns, scan.motion_compensated},
          .features = &selected,
          .structure = static_cast<double>(structure),
          .is_room = in_room,
          .levels = in_room ? Levels::first_known : Levels::from_whole,
          .is_complete = scan.complete};
}

}  // namespace lilo::core
