// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <poll.h>
#include <pty.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace lilo {

/// A program on a terminal of its own.
class OnATerminal {
 public:
  struct Size {
    unsigned short rows = 24, columns = 80;
  };

  /// `words`: the program's path and its arguments.
  OnATerminal(const std::vector<std::string>& words, Size size,
              const std::map<std::string, std::string>& environment = {}) {
    winsize window{.ws_row = size.rows, .ws_col = size.columns};
    pid_ = forkpty(&fd_, nullptr, nullptr, &window);
    if (pid_ != 0) return;
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    setenv("TERM", "xterm", 1);
    unsetenv("NO_COLOR");
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  ~OnATerminal() {
    kill(pid_, SIGKILL);
    close(fd_);
    waitpid(pid_, nullptr, 0);
  }
  OnATerminal(const OnATerminal&) = delete;
  OnATerminal& operator=(const OnATerminal&) = delete;

  /// Everything it has written, once that holds `text`; or after `patience`.
  std::string until(const std::string& text,
                    std::chrono::seconds patience = std::chrono::seconds(10)) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (written_.find(text) == std::string::npos &&
           std::chrono::steady_clock::now() < deadline) {
      pollfd waiting{fd_, POLLIN, 0};
      if (poll(&waiting, 1, 200) <= 0) continue;
      std::array<char, 4096> bytes{};
      const ssize_t size = read(fd_, bytes.data(), bytes.size());
      if (size <= 0) break;
      written_.append(bytes.data(), static_cast<std::size_t>(size));
    }
    return written_;
  }
  /// All of it, and what it is still writing.
  void forget() {
    std::array<char, 65536> bytes{};
    pollfd waiting{fd_, POLLIN, 0};
    while (poll(&waiting, 1, 0) > 0 && read(fd_, bytes.data(), bytes.size()) > 0) {
    }
    written_.clear();
  }
  void press(const std::string& keys) const {
    EXPECT_EQ(write(fd_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  void resize(Size size) const {
    const winsize window{.ws_row = size.rows, .ws_col = size.columns};
    EXPECT_EQ(ioctl(fd_, TIOCSWINSZ, &window), 0);
  }
  /// The exit code.
  [[nodiscard]] int wait() const {
    int status = 0;
    for (int k = 0; k < 100; ++k) {
      if (waitpid(pid_, &status, WNOHANG) == pid_)
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return -2;
  }

 private:
  int fd_ = -1;
  pid_t pid_ = -1;
  std::string written_;
};

}  // namespace lilo
