// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/cell.hpp"

#include "tools/bench/worlds/subprocess.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace lilo::worlds {
namespace {

namespace fs = std::filesystem;

std::string contents(const std::string& path) {
  std::ifstream file = open_text(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A recording that lies somewhere is told from what replaced it by size and time.
std::string state_of(const std::string& path) {
  const fs::path capture = fs::path(path) / "data.pcap";
  if (!fs::is_regular_file(capture)) return path;
  return fmt::format("{} {} {}", path, fs::file_size(capture),
                     fs::last_write_time(capture).time_since_epoch().count());
}

}  // namespace

std::string hash(const std::string& bytes) {
  std::uint64_t value = 14695981039346656037U;
  for (const char c : bytes) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return fmt::format("{:016x}", value);
}

std::string fingerprint(const Variant& variant) {
  const std::string config = variant.config.empty() ? "" : contents(variant.config);
  return hash(contents(variant.program)) + ' ' + hash(config);
}

std::string cell_folder(const std::string& out, const std::string& variant, const Drive& drive) {
  const World& world = drive.world;
  const std::string origin =
      drive.seed ? fmt::format("{} --seed {}", fmt::join(world.arguments, " "), *drive.seed)
                 : state_of(world.path);
  const std::string key =
      fmt::format("{}\n{} {}\n{}", variant, to_string(world.source), world.sensor, origin);
  std::string name = label(drive);
  std::replace(name.begin(), name.end(), ' ', '_');
  return fmt::format("{}/cells/{}_{}", out, name, hash(key));
}

void run_cell(const Variant& variant, const Drive& drive, const BenchmarkSet& recording,
              const std::string& folder, const std::atomic<bool>& stop) {
  if (fs::is_directory(folder)) return;
  const std::string unfinished = folder + ".part", log = folder + ".log";
  fs::create_directories(unfinished);
  std::vector<std::string> words{variant.program, "run", recording.input};
  if (!variant.config.empty()) words.insert(words.end(), {"--config", variant.config});
  words.insert(words.end(), {"--sensor", drive.world.sensor, "--poses", unfinished + "/poses.jsonl",
                             "--stats", unfinished + "/stats.json"});
  const ProgramEnd end = run_program(words, log, stop);
  if (end.stopped || stop) throw Interrupted();
  if (end.exit_code != 0) {
    throw std::runtime_error(
        fmt::format("{}: exit code {}: {}", log, end.exit_code, end.last_line));
  }
  write_tum(unfinished + "/truth.tum", recording.truth->poses);
  fs::remove(log);
  fs::rename(unfinished, folder);
}

}  // namespace lilo::worlds
