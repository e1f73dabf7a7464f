// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/trajectory.hpp"

#include <string>
#include <vector>

namespace lilo {

/// Draws with gnuplot how the errors of position and orientation grow over the true distance, a
/// curve an estimate, each laid over the truth at their first common pose. Beside the PNG `out` lie
/// the script and a CSV file a curve: `out` without .png, then .gp and _1.csv, _2.csv ... Throws
/// std::runtime_error.
void draw_errors(const std::vector<Trajectory>& estimates, const Trajectory& truth,
                 const std::string& title, const std::string& out);

}  // namespace lilo
