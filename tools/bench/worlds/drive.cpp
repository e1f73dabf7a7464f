// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/drive.hpp"

#include "tools/bench/worlds/subprocess.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <regex>
#include <utility>

namespace lilo::worlds {
namespace {

namespace fs = std::filesystem;

std::regex pattern_of(const std::string& only) {
  try {
    return std::regex(only.empty() ? "." : only);
  } catch (const std::regex_error& error) {
    throw std::runtime_error(
        fmt::format("--only: expected a regular expression, found '{}': {}", only, error.what()));
  }
}

std::string folder_of(const Drive& drive, const Studio& studio) {
  return fmt::format("{}/{}/{}", studio.recordings, *drive.seed, drive.world.name);
}

/// What a simulation depends on, kept beside it; the simulator's own version is not part of it.
std::string order_of(const Drive& drive) {
  return fmt::format("{} {} --seed {}\n", to_string(drive.world.source),
                     fmt::join(drive.world.arguments, " "), *drive.seed);
}

constexpr const char* kOrderFile = "/made_by.txt";

/// Folders that something else made have no such file and are believed.
void expect_same_order(const Drive& drive, const std::string& folder) {
  const std::string path = folder + kOrderFile;
  if (!fs::exists(path)) return;
  std::ifstream file = open_text(path);
  std::string found{std::istreambuf_iterator<char>(file), {}};
  const std::string expected = order_of(drive);
  if (found == expected) return;
  found.pop_back();
  throw std::runtime_error(fmt::format("{}: expected '{}', found '{}': remove its folder", path,
                                       expected.substr(0, expected.size() - 1), found));
}

std::vector<std::string> command(const Drive& drive, const Studio& studio,
                                 const std::string& folder) {
  const std::string seed = fmt::format("{}", *drive.seed);
  const bool own = drive.world.source == Source::sim;
  std::vector<std::string> words =
      own ? std::vector<std::string>{studio.lilo, "sim", folder, "--quiet", "--force"}
          : std::vector<std::string>{studio.velosim};
  words.insert(words.end(), drive.world.arguments.begin(), drive.world.arguments.end());
  words.insert(words.end(), {"--seed", seed});
  if (!own) words.insert(words.end(), {"--out", folder, "--threads", "1"});
  return words;
}

void record(const Drive& drive, const Studio& studio, const std::string& folder,
            const std::atomic<bool>& stop) {
  if (drive.world.source == Source::velosim && !fs::is_regular_file(studio.velosim)) {
    throw Skipped(fmt::format("no velosim at {}: --velosim PATH", studio.velosim));
  }
  const std::string unfinished = folder + ".part", log = folder + ".log";
  fs::remove_all(unfinished);
  fs::create_directories(unfinished);
  const ProgramEnd end = run_program(command(drive, studio, unfinished), log, stop);
  if (end.stopped || stop) throw Interrupted();
  if (end.exit_code != 0 || !fs::is_regular_file(unfinished + "/data.pcap")) {
    throw std::runtime_error(
        fmt::format("{}: exit code {}: {}", log, end.exit_code, end.last_line));
  }
  std::ofstream order = create_text(unfinished + kOrderFile);
  order << order_of(drive);
  finish_text(order, unfinished + kOrderFile);
  fs::rename(unfinished, folder);
}

}  // namespace

std::string label(const Drive& drive) {
  return drive.seed ? fmt::format("{} {}", drive.world.name, *drive.seed) : drive.world.name;
}

std::vector<Drive> drives_of(const WorldList& list, const std::vector<Role>& roles,
                             const std::string& only) {
  const std::regex pattern = pattern_of(only);
  std::vector<Drive> drives;
  for (const World& world : list.worlds) {
    if (!std::regex_search(world.name, pattern)) continue;
    for (const Role role : roles) {
      if (world.source == Source::recording) {
        if (world.role == role) drives.push_back({world, std::nullopt, role});
        continue;
      }
      const auto& seeds = role == Role::choose ? list.choose : list.report;
      for (const std::uint64_t seed : seeds) drives.push_back({world, seed, role});
    }
  }
  return drives;
}

BenchmarkSet recording_of(const Drive& drive, const Studio& studio, const std::atomic<bool>& stop) {
  std::string folder = drive.world.path;
  if (drive.world.source == Source::recording) {
    if (!fs::is_directory(folder)) throw Skipped(fmt::format("no recording at {}", folder));
  } else {
    folder = folder_of(drive, studio);
    expect_same_order(drive, folder);
    if (!fs::is_regular_file(folder + "/data.pcap")) record(drive, studio, folder, stop);
  }
  return find_sets_with_truth({folder}).front();
}

}  // namespace lilo::worlds
