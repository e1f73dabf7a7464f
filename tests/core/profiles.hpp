// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry.hpp"

#include <vector>

namespace lilo::test {

/// Those that this build has.
inline std::vector<Profile> profiles() {
  if (!has_profile(Profile::paper)) return {Profile::default_profile};
  return {Profile::default_profile, Profile::paper};
}

}  // namespace lilo::test
