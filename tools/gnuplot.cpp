// SPDX-License-Identifier: BSD-3-Clause
#include "tools/gnuplot.hpp"

#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <array>
#include <fcntl.h>
#include <filesystem>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace lilo {
namespace {

/// Runs gnuplot with its complaints going to a file. Returns its exit status; 127: there is none.
int spawn_gnuplot(const std::string& folder, const std::string& script, const std::string& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::string program = "gnuplot", argument = script;
  const std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return 127;
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

/// gnuplot's complaint, without the script's text and the caret it shows first.
std::string complaint(const std::string& log) {
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line)) {
    if (line.find_first_not_of(" \t^") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace

void run_gnuplot(const std::string& folder, const std::string& name, const std::string& script) {
  const std::string path = (std::filesystem::path(folder) / (name + ".gp")).string();
  std::ofstream file = create_text(path);
  file << script;
  finish_text(file, path);
  const std::string log = std::filesystem::absolute(path).string() + ".log";
  const int status = spawn_gnuplot(folder, "./" + name + ".gp", log);
  const std::string said = complaint(log);
  std::filesystem::remove(log);
  if (status == 127) {
    throw std::runtime_error("charts need gnuplot: install the package gnuplot-nox");
  }
  if (status != 0) throw std::runtime_error(fmt::format("{}: gnuplot: {}", path, said));
}

std::string gnuplot_head(const std::string& png, int width, int height) {
  return fmt::format(R"(set terminal pngcairo size {},{} font "DejaVu Sans,13" background "white"
set output {}
set datafile separator comma
set datafile missing ""
set border 3 linecolor rgb "#404040"
set tics nomirror out
set format '%g'
set autoscale xfixmax
set grid ytics back linetype 1 linecolor rgb "#e0e0e0" linewidth 1
set key top left outside horizontal samplen 2 noenhanced
)",
                     width, height, gnuplot_file(png));
}

std::string gnuplot_text(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += c;
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

std::string gnuplot_file(const std::string& name) {
  // A script is read line by line: a new line stands in double quotes of its own.
  std::string result;
  std::istringstream lines("./" + name);
  for (std::string line; std::getline(lines, line);) {
    result += (result.empty() ? "" : R"(."\n".)") + gnuplot_text(line);
  }
  return result;
}

}  // namespace lilo
