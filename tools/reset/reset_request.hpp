// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace lilo {

/// The request of daemon/PROTOCOL.md that begins a session at x y z (m), turned by roll, pitch and
/// yaw (degrees, about the fixed axes, REP-103) where these are given; at the identity when `pose`
/// is empty. Throws std::runtime_error for any other count of numbers.
nlohmann::json reset_request(const std::vector<double>& pose);

}  // namespace lilo
