// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/registration/solver.hpp"

/// Comparison of two alignments of one scan from different hypotheses.
namespace lilo::core {

/// Whether as much of the structure fits under one as under the other (kFitsAsWell).
bool fits_as_well(const Solution& one, const Solution& other);

/// Whether the scan tells the places of the two apart: along the line between them it has
/// kTellsApart times the information of its duration. Along a corridor a scan fits at any place, so
/// that both fit is no evidence.
bool tells_apart(const Solution& one, const Solution& other);

}  // namespace lilo::core
