// SPDX-License-Identifier: BSD-3-Clause
#include "config/config.hpp"
#include "config/print_config.hpp"
#include "config/version.hpp"
#include "core/odometry.hpp"
#include "daemon/health_monitor.hpp"
#include "daemon/log.hpp"
#include "daemon/paper_program.hpp"
#include "daemon/service.hpp"
#include "drivers/scan_builder.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

namespace lilo {
namespace {

// Exit codes, also in README.md.
constexpr int kSuccess = 0, kFailure = 1, kBadUsage = 2;

struct Options {
  std::string config_path;
  bool check_config = false;
  bool print_config = false;
  bool print_reference = false;
};

// Without it a restart would end in the same way, again and again.
void check_calibration(const Options& options, const SensorConfig& sensor) {
  try {
    (void)configured_calibration(sensor);
  } catch (const DriverError& error) {
    throw ConfigError(options.config_path + ": sensor.calibration_file: " + error.what());
  }
}

int run(const Options& options, char** argv) {
  if (options.print_reference) {
    std::cout << print_reference();
    return kSuccess;
  }
  if (options.config_path.empty()) {
    if (!options.print_config) throw CLI::RequiredError("--config FILE");
    std::cout << print_config({});
    return kSuccess;
  }
  const Config config = load_config(options.config_path);
  if (!has_profile(config.odometry.profile))
    throw ConfigError(options.config_path + ": " + become_paper_program(argv));
  if (options.print_config) std::cout << print_config(config);
  if (options.print_config && !options.check_config) return kSuccess;
  check_calibration(options, config.sensor);
  if (options.check_config) {
    std::cout << options.config_path << ": ok\n";
    return kSuccess;
  }
  start_log(config.log.level, instance_name(options.config_path));
  Service(config, options.config_path).run();
  return kSuccess;
}

int run(int argc, char** argv) {
  CLI::App app{"lilod: LiDAR odometry daemon. Packets in by UDP, poses out by UDP/JSON."};
  app.set_version_flag("--version", std::string("lilod ") + kVersionText);
  Options options;
  app.add_option("--config", options.config_path, "YAML file; see config/vlp16.yaml");
  app.add_flag("--check-config", options.check_config, "Check the file and end: 0 good, 2 bad");
  app.add_flag("--print-config", options.print_config, "Print what is in force, and end");
  app.add_flag("--print-reference", options.print_reference, "Print all keys as Markdown, and end");
  try {
    app.parse(argc, argv);
    return run(options, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "lilod: %s (lilod --help)\n", error.what());
    return kBadUsage;
  } catch (const ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kBadUsage;
  }
}

}  // namespace
}  // namespace lilo

int main(int argc, char** argv) {
  try {
    return lilo::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lilod: %s\n", error.what());
    return lilo::kFailure;
  }
}
