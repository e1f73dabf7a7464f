// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/connection/connection.hpp"
#include "tools/status/status_report.hpp"

namespace lilo {

/// Asks a daemon for its health and its last pose. Throws std::runtime_error.
StatusReport read_status(Connection& lilod);

}  // namespace lilo
