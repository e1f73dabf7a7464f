// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"

#include <vector>

namespace lilo {

/// Finds the ring of every return of a KITTI scan and fills `beams` and Return::ring.
///
/// The files keep no ring numbers, but they store the HDL-64E's rings one after another, highest
/// first, each once around counter-clockwise from straight ahead: where the azimuth falls back to
/// ahead, the next ring begins. Where that finds no plausible number of rings (60 to 64), the
/// returns were sorted otherwise, and rings are bins of elevation instead.
void recover_kitti_rings(Returns& returns, BeamTable& beams);

}  // namespace lilo
