// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/mesh.hpp"
#include "tools/sim/random.hpp"

/// Plants, each one different. The origin is where the stem meets the ground.
namespace lilo::sim {

/// Bent trunk, branches, and thousands of leaves; 5 to 13 m high.
Mesh make_broadleaf_tree(Random& random);
/// The same, pruned so that people and cars pass below: no leaves under 2.8 m.
Mesh make_street_tree(Random& random);
/// Straight trunk and drooping tiers; 5 to 14 m high.
Mesh make_conifer(Random& random);
/// The same skeleton as a broad-leaved tree, without leaves.
Mesh make_bare_tree(Random& random);
/// 0.6 to 1.8 m high.
Mesh make_bush(Random& random);
/// A few blades, 0.1 to 0.4 m high.
Mesh make_grass_tuft(Random& random);
/// Along x from 0 to `length_m`, 0.7 to 1.8 m high.
Mesh make_hedge(Random& random, double length_m);

}  // namespace lilo::sim
