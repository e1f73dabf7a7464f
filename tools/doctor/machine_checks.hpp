// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace lilo::doctor {

/// Whether this computer is as the configuration needs it; each looks at what its name says.
Finding check_card(const Config& config, const Machine& machine);
Finding check_receive_buffer(const Config& config, const Machine& machine);
Finding check_priority(const Config& config, const Machine& machine);
Finding check_memory_lock(const Config& config, const Machine& machine);
Finding check_cpu(const Config& config, const Machine& machine);
Finding check_clock(const Machine& machine);
Finding check_disk(const Machine& machine);

}  // namespace lilo::doctor
