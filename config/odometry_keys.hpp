// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/key.hpp"

#include <vector>

namespace lilo {

/// The keys of `odometry`, `odometry.default` and `odometry.paper`, in the order of the files.
std::vector<Key> odometry_keys();
std::vector<Key> default_profile_keys();
std::vector<Key> paper_keys();

}  // namespace lilo
