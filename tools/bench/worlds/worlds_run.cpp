// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/worlds_run.hpp"

#include "tools/stop_signals.hpp"
#include "tools/terminal/progress_bar.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace lilo::worlds {
namespace {

namespace fs = std::filesystem;

/// The drives in their order, shared by the threads that work them off.
class Work {
 public:
  Work(const std::vector<Drive>& drives, const Settings& settings)
      : drives_(drives), settings_(settings), outcomes_(drives.size()) {
    for (const Variant& variant : settings.variants) fingerprints_.push_back(fingerprint(variant));
  }

  /// Until nothing is left or stop() was called.
  void work_off() {
    for (std::size_t k = next_++; k < drives_.size() && !stop_; k = next_++) {
      try {
        outcomes_[k] = outcome_of(drives_[k]);
      } catch (const Interrupted&) {
        return;
      }
      report(k);
    }
  }
  void stop() { stop_ = true; }

  [[nodiscard]] std::size_t done() const { return done_; }
  [[nodiscard]] const std::vector<Outcome>& outcomes() const { return outcomes_; }

 private:
  Outcome outcome_of(const Drive& drive) {
    Outcome outcome{.drive = drive};
    try {
      outcome.figures = figures_of(drive);
    } catch (const Skipped& skipped) {
      outcome.trouble = skipped.what();
      outcome.skipped = true;
    } catch (const std::exception& error) {
      outcome.trouble = error.what();
    }
    return outcome;
  }

  std::vector<Figures> figures_of(const Drive& drive) {
    std::vector<std::string> folders;
    bool finished = true;
    for (const std::string& variant : fingerprints_) {
      folders.push_back(cell_folder(settings_.out, variant, drive));
      finished = finished && fs::is_directory(folders.back());
    }
    if (!finished) run(drive, folders);
    std::vector<Figures> figures;
    figures.reserve(folders.size());
    for (const std::string& folder : folders) {
      figures.push_back(read_figures(folder, settings_.lengths_m));
    }
    return figures;
  }

  void run(const Drive& drive, const std::vector<std::string>& folders) {
    const BenchmarkSet recording = recording_of(drive, settings_.studio, stop_);
    for (std::size_t v = 0; v < folders.size(); ++v) {
      run_cell(settings_.variants[v], drive, recording, folders[v], stop_);
    }
  }

  void report(std::size_t k) {
    const Outcome& outcome = outcomes_[k];
    std::string what = outcome.trouble;
    for (const Figures& f : outcome.figures) {
      what += fmt::format("{}ATE {:.3f} m, {:.1f} % tracking, {:.0f} of them false, {:.1f} ms",
                          what.empty() ? "" : " | ", f.ate_m, f.tracking_percent, f.false_tracking,
                          f.cpu_p50_ms);
    }
    const std::lock_guard lock(printing_);
    fmt::print(stderr, "{}{:>4}/{} {:<16} {}\n", on_terminal_ ? "\r\033[K" : "", ++done_,
               drives_.size(), label(outcome.drive), what);
  }

  const std::vector<Drive>& drives_;
  const Settings& settings_;
  std::vector<std::string> fingerprints_;  // of the variants
  std::vector<Outcome> outcomes_;          // each written by the thread that has its drive
  std::atomic<std::size_t> next_{0}, done_{0};
  std::atomic<bool> stop_{false};
  std::mutex printing_;
  bool on_terminal_ = isatty(STDERR_FILENO) != 0;  // where the bar must be taken away first
};

/// Watches the work from outside until it is done.
void watch(Work& work, std::size_t all, const std::atomic<unsigned>& working,
           StopSignals& signals) {
  constexpr auto kPeriod = std::chrono::milliseconds(20);
  ProgressBar bar;
  while (working > 0) {
    if (signals.raised()) work.stop();
    if (bar.due()) {
      bar.show({static_cast<double>(work.done()) / static_cast<double>(all), 0,
                fmt::format("{}/{}", work.done(), all)});
    }
    std::this_thread::sleep_for(kPeriod);
  }
}

}  // namespace

std::vector<Outcome> run_worlds(const std::vector<Drive>& drives, const Settings& settings) {
  StopSignals signals;
  Work work(drives, settings);
  std::atomic<unsigned> working{settings.jobs};
  {
    std::vector<std::jthread> threads;
    for (unsigned k = 0; k < settings.jobs; ++k) {
      threads.emplace_back([&] {
        work.work_off();
        --working;
      });
    }
    watch(work, drives.size(), working, signals);
  }
  if (signals.raised() && work.done() < drives.size()) {
    throw std::runtime_error(
        fmt::format("interrupted, {} of {} recordings are done: the same command goes on",
                    work.done(), drives.size()));
  }
  return work.outcomes();
}

}  // namespace lilo::worlds
