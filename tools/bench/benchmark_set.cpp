// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/benchmark_set.hpp"

#include "tools/kitti_truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

namespace lilo {
namespace {

namespace fs = std::filesystem;

std::optional<Trajectory> capture_truth(const fs::path& folder) {
  for (const char* name : {"gt_end.tum", "truth.tum"}) {
    if (fs::is_regular_file(folder / name)) return read_trajectory((folder / name).string());
  }
  return std::nullopt;
}

bool has_sequence_truth(const fs::path& folder) {
  const std::string number = folder.filename().string() + ".txt";
  return fs::is_regular_file(folder / "poses.txt") ||
         fs::is_regular_file(folder.parent_path().parent_path() / "poses" / number);
}

/// The folder as a set, if it is one.
std::optional<BenchmarkSet> set_of(const fs::path& folder) {
  BenchmarkSet set{.name = folder.filename().string(), .input = folder.string()};
  if (fs::is_directory(folder / "velodyne")) {
    if (has_sequence_truth(folder)) set.truth = kitti_sequence_truth(folder.string());
    return set;
  }
  if (fs::is_directory(folder / "velodyne_points" / "data")) {
    if (fs::is_directory(folder / "oxts" / "data")) set.truth = kitti_raw_truth(folder.string());
    return set;
  }
  if (!fs::is_regular_file(folder / "data.pcap")) return std::nullopt;
  set.input = (folder / "data.pcap").string();
  set.truth = capture_truth(folder);
  return set;
}

constexpr int kDeepest = 4;  // a data set's root, and links that go round

void add_sets_in(const fs::path& folder, int depth, std::vector<BenchmarkSet>& sets) {
  if (auto set = set_of(folder)) {
    sets.push_back(std::move(*set));
    return;
  }
  if (depth == kDeepest) return;
  std::vector<fs::path> folders;
  for (const auto& item : fs::directory_iterator(folder)) {
    if (item.is_directory()) folders.push_back(item.path());
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& inner : folders) add_sets_in(inner, depth + 1, sets);
}

std::vector<BenchmarkSet> sets_at(const std::string& path) {
  if (fs::is_regular_file(path)) return {{fs::path(path).stem().string(), path, std::nullopt}};
  if (!fs::is_directory(path)) {
    throw std::runtime_error(fmt::format("{}: expected a folder or a capture, found none", path));
  }
  std::vector<BenchmarkSet> sets;
  add_sets_in(fs::canonical(path), 0, sets);
  if (!sets.empty()) return sets;
  throw std::runtime_error(fmt::format(
      "{}: expected a set (data.pcap or velodyne/) or folders of sets, found none", path));
}

}  // namespace

std::vector<BenchmarkSet> find_sets(const std::vector<std::string>& paths) {
  std::vector<BenchmarkSet> all;
  std::set<std::string> names;
  for (const std::string& path : paths) {
    for (BenchmarkSet& set : sets_at(path)) {
      if (!names.insert(set.name).second) {
        throw std::runtime_error(
            fmt::format("{}: expected sets of different names, found {} twice", path, set.name));
      }
      all.push_back(std::move(set));
    }
  }
  return all;
}

std::vector<BenchmarkSet> find_sets_with_truth(const std::vector<std::string>& paths) {
  std::vector<BenchmarkSet> sets = find_sets(paths);
  for (const BenchmarkSet& set : sets) {
    if (set.truth) continue;
    throw std::runtime_error(fmt::format(
        "{}: expected true poses (gt_end.tum, truth.tum, poses.txt), found none", set.input));
  }
  return sets;
}

Trajectory read_truth(const std::string& path) {
  if (!fs::is_directory(path)) return read_trajectory(path);
  return *find_sets_with_truth({path}).front().truth;
}

}  // namespace lilo
