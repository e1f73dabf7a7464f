// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/daemon/conversation.hpp"
#include "tests/daemon/text_of.hpp"

#include <filesystem>

namespace lilo {

inline const std::string kLilo = LILO_BIN_DIR "/lilo";

/// A running lilod that may save, and the commands of lilo that talk to it.
class Operator : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(lilod.wait_ready()); }

  [[nodiscard]] std::vector<std::string> words(std::vector<std::string> command) const {
    command.insert(command.begin(), kLilo);
    command.insert(command.end(), {"--port", std::to_string(lilod.server_port())});
    return command;
  }
  [[nodiscard]] Finished run(const std::vector<std::string>& command) const {
    return run_to_end(words(command));
  }
  /// Until the daemon tracks and has nothing to complain of, or not.
  [[nodiscard]] bool becomes_good() const {
    const auto deadline = std::chrono::steady_clock::now() + seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      if (run({"status"}).exit_code == 0) return true;
      std::this_thread::sleep_for(milliseconds(200));
    }
    return false;
  }

  std::string state = unique_path("state");
  Lilod lilod{"state:\n  directory: " + (std::filesystem::create_directories(state), state) + '\n'};
};

}  // namespace lilo
