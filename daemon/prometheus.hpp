// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/health.hpp"

#include <string>

namespace lilo {

/// Health for Prometheus' node_exporter, in its text format, in place of what `out` held. Every
/// sample has the label `instance`, so that several daemons can share a collector. `out` keeps its
/// memory: from the second time on, nothing is allocated.
void write_prometheus(const std::string& session, const Health& health, std::string& out);

}  // namespace lilo
