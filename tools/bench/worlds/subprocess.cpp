// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/subprocess.hpp"

#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every unistd.h

namespace lilo {
namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(10);
constexpr std::array kOneThread{"OMP_NUM_THREADS=1", "OPENCV_FOR_THREADS_NUM=1"};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  out.reserve(texts.size() + 1);
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

std::vector<std::string> environment() {
  std::vector<std::string> out(kOneThread.begin(), kOneThread.end());
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (!text.starts_with("OMP_NUM_THREADS=") && !text.starts_with("OPENCV_FOR_THREADS_NUM=")) {
      out.emplace_back(text);
    }
  }
  return out;
}

/// What posix_spawn() is told: output into a file, no input, and no signal blocked, as
/// StopSignals does for this process.
class SpawnSettings {
 public:
  explicit SpawnSettings(const std::string& output_file) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_file.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }

  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
};

pid_t start(std::vector<std::string> words, const std::string& output_file) {
  const SpawnSettings settings(output_file);
  std::vector<std::string> variables = environment();
  pid_t pid = -1;
  const int error = posix_spawn(&pid, words[0].c_str(), &settings.actions, &settings.attributes,
                                pointers(words).data(), pointers(variables).data());
  if (error == 0) return pid;
  throw std::runtime_error(
      fmt::format("{}: cannot start it: {}", words[0], std::generic_category().message(error)));
}

std::string last_line(const std::string& path) {
  std::ifstream file = open_text(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace

ProgramEnd run_program(const std::vector<std::string>& words, const std::string& output_file,
                       const std::atomic<bool>& stop) {
  const pid_t pid = start(words, output_file);
  ProgramEnd end;
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) != pid) {
    if (stop && !end.stopped) {
      end.stopped = true;
      kill(pid, SIGTERM);
    }
    std::this_thread::sleep_for(kPollPeriod);
  }
  end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  end.last_line = last_line(output_file);
  return end;
}

}  // namespace lilo
