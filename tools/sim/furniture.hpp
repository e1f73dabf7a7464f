// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/mesh.hpp"
#include "tools/sim/random.hpp"

/// What stands about in streets and parks. Origin on the ground, x along the road.
namespace lilo::sim {

/// 4 to 9 m high; the arm reaches towards +y.
Mesh make_lamp_post(Random& random);
/// One or two reflecting plates facing -x.
Mesh make_sign(Random& random);
Mesh make_bollard(Random& random);
Mesh make_bin(Random& random);
Mesh make_bench(Random& random);
/// Overhead line post, 7 to 9 m, with cross-arm along y.
Mesh make_line_post(Random& random);
/// Roadside delineator, 1 m high with a reflector.
Mesh make_delineator(Random& random);
/// A lump of 0.2 to 0.9 m.
Mesh make_rock(Random& random);

}  // namespace lilo::sim
