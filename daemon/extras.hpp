// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lilo {

/// What a subscriber may be sent besides poses and health.
struct Extras {
  bool points = false;   ///< what was seen with every pose
  bool packets = false;  ///< the sensor's packets
};

}  // namespace lilo
