// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/mesh.hpp"
#include "tools/sim/random.hpp"

namespace lilo::sim {

/// A house of its own: front wall along x from 0 to `width_m` at y = 0, the rest of it at y > 0,
/// foot at z = 0. Windows, doors and shop fronts lie in recesses; cornices, balconies, steps and
/// down-pipes stand out.
Mesh make_house(Random& random, double width_m);

}  // namespace lilo::sim
