// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/mesh.hpp"
#include "tools/sim/random.hpp"

/// What lines roads. Origin on the ground, x along the road; pieces run from -kPiece_m / 2 to
/// kPiece_m / 2 and are put up one behind the other.
namespace lilo::sim {

inline constexpr double kPiece_m = 4.0;

/// Folded steel rail on posts; the road is on the -y side.
Mesh make_guard_rail(Random& random);
/// Concrete barrier, 0.8 m.
Mesh make_concrete_barrier(Random& random);
/// Panel of a noise barrier, 2.5 to 4 m, with its post.
Mesh make_noise_wall(Random& random);
/// Two posts and rails of a pasture fence.
Mesh make_fence(Random& random);
/// Columns at y = -half_width_m and half_width_m, a truss above the road, plates on it.
Mesh make_gantry(Random& random, double half_width_m);
/// Abutments, deck and parapets of a road across; clears 2 * half_width_m.
Mesh make_bridge(Random& random, double half_width_m);
/// Large sign on two posts, facing -x.
Mesh make_road_sign(Random& random);

}  // namespace lilo::sim
