// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/faults.hpp"
#include "tools/sim/options.hpp"

#include <functional>
#include <string>

namespace lilo::sim {

struct SimSummary {
  std::size_t revolutions = 0;
  std::uint64_t packets_sent = 0;  ///< data packets the sensor made
  std::uint64_t position_packets = 0;
  FaultCounts faults;  ///< and what became of them on the way
  double path_length_m = 0.0;
};

/// Drives the sensor through the world and writes the capture and its truth into `folder` (made if
/// missing). Same options, same bytes. `progress` is called with [0, 1] now and then.
/// Throws std::invalid_argument for impossible options and std::runtime_error when files cannot be
/// written.
SimSummary simulate(const SimOptions& options, const std::string& folder,
                    const std::function<void(double)>& progress);

}  // namespace lilo::sim
