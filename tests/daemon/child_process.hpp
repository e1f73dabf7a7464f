// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace lilo {

/// A program with its output in files, for tests. Killed when the object goes.
class ChildProcess {
 public:
  /// Throws std::system_error when it cannot be started.
  explicit ChildProcess(const std::vector<std::string>& arguments,
                        const std::map<std::string, std::string>& environment = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void signal(int number) const;
  /// The exit code, 128 + the signal that ended it, or nothing when it still runs.
  std::optional<int> wait(std::chrono::milliseconds at_most);

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] std::string standard_output() const;
  [[nodiscard]] std::string standard_error() const;

 private:
  std::string output_path_, error_path_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

/// Runs a program to its end; "still running" is a failure of the test that asks.
struct Finished {
  int exit_code;
  std::string output, error;
};
Finished run_to_end(const std::vector<std::string>& arguments);

}  // namespace lilo
