// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/paper_bench.hpp"

#include "config/print_config.hpp"
#include "tools/bench/paper/ledger.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal/progress_bar.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <stdexcept>

namespace lilo::paper_bench {
namespace {

namespace fs = std::filesystem;

/// A cell still to be run.
struct Work {
  Cell cell;
  const BenchmarkSet* set;
  SetFacts facts;
};

std::vector<Work> all_work(const std::vector<BenchmarkSet>& sets, const SensorConfig& sensor) {
  std::vector<Work> work;
  for (const BenchmarkSet& set : sets) {
    const SetFacts facts = look_at(set, sensor);
    for (const Cell& cell : cells_of(set.name, facts.beams, facts.deskewed)) {
      work.push_back({cell, &set, facts});
    }
  }
  return work;
}

/// What results depend on besides the sets; kept in the folder.
std::string settings_text(const Settings& settings) {
  Config config;
  config.sensor = settings.sensor;
  config.odometry = settings.odometry;
  return fmt::format("# segment lengths (m): {}\n# scans of a set at most: {}\n{}",
                     settings.lengths_m.empty()
                         ? "the devkit's, shorter on short paths"
                         : fmt::format("{:g}", fmt::join(settings.lengths_m, " ")),
                     settings.most_scans == 0 ? "all" : fmt::format("{}", settings.most_scans),
                     print_config(config));
}

void claim_folder(const std::string& folder, const std::string& settings) {
  for (const char* inner : {"scans", "poses", "tracks"})
    fs::create_directories(fs::path(folder) / inner);
  const std::string path = folder + "/settings.yaml";
  if (fs::exists(path)) {
    std::ifstream file = open_text(path);
    const std::string before{std::istreambuf_iterator<char>(file), {}};
    if (before == settings) return;
    throw std::runtime_error(fmt::format(
        "{}: expected the settings of this call, found others: choose another --out", path));
  }
  std::ofstream file = create_text(path);
  file << settings;
  finish_text(file, path);
}

std::string name_of(const Cell& cell) {
  std::string name = file_stem(cell);
  std::replace(name.begin() + static_cast<std::ptrdiff_t>(cell.set.size()), name.end(), '_', ' ');
  return name;
}

std::string result_line(const CellResult& result) {
  const std::string errors =
      std::isnan(result.t_percent)
          ? fmt::format("path {:.1f} m is too short", result.path_m)
          : fmt::format("{:6.2f} % {:6.2f} deg/100 m", result.t_percent, result.r_deg_per_100m);
  return fmt::format("{:<42} {:<26} ATE {:7.3f} m {:7.1f} ms\n", name_of(result.cell), errors,
                     result.ate_m, result.total_ms);
}

/// Runs what the ledger does not have.
void work_off(const std::vector<Work>& work, const Settings& settings, const std::string& folder,
              Ledger& ledger) {
  StopSignals stop;
  std::size_t done = 0;
  for (const Work& item : work) {
    if (ledger.find(item.cell) == nullptr) {
      CellResult result;
      try {
        ProgressBar bar;
        result = run_cell(item.cell, *item.set, item.facts, settings, folder, [&](double part) {
          const double all = (static_cast<double>(done) + part) / static_cast<double>(work.size());
          if (bar.due()) {
            bar.show({all, 0, fmt::format("{}/{} {}", done + 1, work.size(), name_of(item.cell))});
          }
          return !stop.raised();
        });
      } catch (const Interrupted&) {
        throw std::runtime_error(fmt::format(
            "interrupted, {} of {} cells are done: the same command goes on", done, work.size()));
      }
      ledger.add(result);
      fmt::print("{}", result_line(result));
      std::fflush(stdout);
    }
    ++done;
  }
}

}  // namespace

void run_paper_bench(const std::vector<BenchmarkSet>& sets, const Settings& settings,
                     const std::string& folder) {
  claim_folder(folder, settings_text(settings));
  Ledger ledger(folder + "/cells.csv");
  const std::vector<Work> work = all_work(sets, settings.sensor);
  work_off(work, settings, folder, ledger);
  std::vector<CellResult> results;  // in the order of the call, whatever else the ledger holds
  results.reserve(work.size());
  for (const Work& item : work) results.push_back(*ledger.find(item.cell));
  write_report(sets, results, folder);
}

}  // namespace lilo::paper_bench
