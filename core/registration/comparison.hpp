// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/registration/solver.hpp"

/// Comparison of two alignments of one scan that began at different hypotheses.
namespace lilo::core {

/// Whether as much of the structure fits under one as under the other (kFitsAsWell).
bool fits_as_well(const Solution& one, const Solution& other);

/// Whether the scan tells of the direction in which the two differ: far more than its own duration
/// does (kTellsApart). Along a corridor it fits at any place, and that both fit is no evidence.
bool tells_apart(const Solution& one, const Solution& other);

}  // namespace lilo::core
