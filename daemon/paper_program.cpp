// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/paper_program.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace lilo {

std::string become_paper_program(char** argv) {
  // Where it is installed, and where it is built.
  const std::filesystem::path us = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path paper =
      us.parent_path().parent_path() / "libexec" / "lilod" / "lilod-paper";
  execv(paper.c_str(), argv);
  return fmt::format(
      "odometry.profile: expected default, or paper and the program {} (package lilo-tools), found "
      "paper and: {}",
      paper.string(), std::generic_category().message(errno));
}

}  // namespace lilo
