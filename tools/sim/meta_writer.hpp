// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/options.hpp"
#include "tools/sim/rotor.hpp"
#include "tools/sim/scene.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/sim/truth_writer.hpp"

#include <string>

namespace lilo::sim {

/// Writes meta.json: what was asked for and what became of it.
void write_meta(const std::string& folder, const SimOptions& options, const SimSummary& summary,
                const PathSummary& path, const Scene& scene, const Rotor& rotor);

/// Whether there is a meta.json of ours in the folder.
bool is_made_by_sim(const std::string& folder);

std::string sensor_name(Sensor sensor);

}  // namespace lilo::sim
