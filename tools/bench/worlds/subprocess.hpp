// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace lilo {

/// Another program run to its end.
struct ProgramEnd {
  int exit_code = 0;      ///< 128 + the signal that ended it
  std::string last_line;  ///< of what it printed
  bool stopped = false;   ///< because `stop` was set
};

/// Runs the program `words[0]` with these arguments, as they are: no shell is between. What it
/// prints goes into `output_file`. Its libraries are told to use one thread. When `stop` is set it
/// is ended. Throws std::runtime_error when it cannot be started.
ProgramEnd run_program(const std::vector<std::string>& words, const std::string& output_file,
                       const std::atomic<bool>& stop);

/// This program, even when another has been built in its place meanwhile.
inline constexpr const char* kOwnProgram = "/proc/self/exe";

}  // namespace lilo
