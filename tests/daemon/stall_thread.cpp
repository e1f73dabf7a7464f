// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/ptrace.h>
#include <sys/wait.h>

/// stall_thread PID NAME: stops that thread of a process, as a debugger would, until the process
/// ends. The hook by which tests/daemon/booted stalls the worker.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string tasks = std::string("/proc/") + argv[1] + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm"), name);
    if (name != argv[2]) continue;
    const pid_t thread = std::atoi(task.path().filename().c_str());
    if (ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0 ||
        ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) != 0) {
      std::perror("ptrace");
      return 1;
    }
    int status = 0;
    do waitpid(thread, &status, __WALL);
    while (!WIFEXITED(status) && !WIFSIGNALED(status));
    return 0;
  }
  std::fprintf(stderr, "%s has no thread %s\n", argv[1], argv[2]);
  return 1;
}
