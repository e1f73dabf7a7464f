// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lilo::worlds {

/// The text of worlds.yaml.
extern const char* const kDefaultWorlds;

}  // namespace lilo::worlds
