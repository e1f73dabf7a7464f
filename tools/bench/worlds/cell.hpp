// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/worlds/drive.hpp"

#include <atomic>
#include <string>

namespace lilo::worlds {

/// A build of lilo and a configuration for it.
struct Variant {
  std::string program;
  std::string config;  ///< YAML file; empty: what is built in
};

/// What the results of a variant depend on: the bytes of its program and of its configuration.
/// Throws std::runtime_error when one cannot be read.
std::string fingerprint(const Variant& variant);

/// Sixteen hexadecimal digits: FNV-1a, 64 bit.
std::string hash(const std::string& bytes);

/// Where the results of a variant over a drive are kept below `out`; another build, configuration,
/// world or seed is another folder. `variant`: its fingerprint. Throws std::runtime_error.
std::string cell_folder(const std::string& out, const std::string& variant, const Drive& drive);

/// A cell that has its folder is finished. Runs it otherwise: poses.jsonl and stats.json of
/// `lilo run`, truth.tum. Throws std::runtime_error (the program failed) or Interrupted.
void run_cell(const Variant& variant, const Drive& drive, const BenchmarkSet& recording,
              const std::string& folder, const std::atomic<bool>& stop);

}  // namespace lilo::worlds
