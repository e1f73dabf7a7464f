// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

/// Skips the test where the folder of captures with truth is not at hand.
#define LILO_NEED_DATA(relative)                                             \
  if (!std::filesystem::exists(std::string(LILO_DATA_DIR "/") + (relative))) \
  GTEST_SKIP() << "needs " << (LILO_DATA_DIR "/") << (relative) << ": set LILO_DATA_DIR"

namespace lilo::test {

inline std::string data_path(const std::string& relative) {
  return std::string(LILO_DATA_DIR "/") + relative;
}

}  // namespace lilo::test
