// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lilo {

/// The folder in which npm has put @mcap/core, what Foxglove reads and writes MCAP files by.
inline std::string node_modules() {
  const char* folder = std::getenv("LILO_NPM_DIR");
  return folder == nullptr ? LILO_NPM_DIR : folder;
}

inline bool has_mcap_core() {
  return std::filesystem::exists(node_modules() + "/node_modules/@mcap/core");
}

/// Why a test that needs it skips.
inline std::string without_mcap_core() {
  return "no @mcap/core: npm install --prefix " + node_modules() + " @mcap/core";
}

}  // namespace lilo
