// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/mesh.hpp"
#include "tools/sim/random.hpp"

/// What can move. Origin on the ground below the middle, x forward.
namespace lilo::sim {

/// Hatchbacks to vans, 3.6 to 5.2 m long.
Mesh make_car(Random& random);
/// Cab and trailer, 7 to 15 m long.
Mesh make_truck(Random& random);
/// A person without legs; 1.5 to 1.9 m high.
Mesh make_walker_body(Random& random);
/// One leg hanging from the hip, which is the origin.
Mesh make_leg(Random& random);
inline constexpr double kHip_m = 0.85;

}  // namespace lilo::sim
