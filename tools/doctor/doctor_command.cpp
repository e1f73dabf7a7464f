// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/doctor_command.hpp"

#include "tools/cli.hpp"
#include "tools/connection/connection.hpp"
#include "tools/doctor/machine_checks.hpp"
#include "tools/doctor/wire.hpp"
#include "tools/message_numbers.hpp"
#include "tools/terminal/printable.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <unistd.h>

namespace lilo {
namespace {

using doctor::Finding;
using doctor::Verdict;

struct DoctorOptions {
  std::string config;
  double seconds = 3.0;
  bool json = false;
};

/// Where the service keeps its state when the configuration names no place: links of systemd's,
/// into a folder that only root may look into.
std::string state_folder(const Config& config, const std::string& config_path) {
  if (!config.state.directory.empty()) return config.state.directory;
  const std::string stem = std::filesystem::path(config_path).stem().string();
  for (const std::string& of_unit : {"/var/lib/lilod-" + stem, std::string("/var/lib/lilod")}) {
    std::error_code error;
    if (exists(std::filesystem::symlink_status(of_unit, error))) return of_unit;
  }
  return {};
}

doctor::RunningDaemon ask_daemon(const Config& config) {
  doctor::RunningDaemon daemon;
  try {
    Connection lilod({.host = "127.0.0.1", .port = config.subscribe.port},
                     Connection::Milliseconds(1000));
    const nlohmann::json health = lilod.ask({{"query", "health"}}, "health").at("health");
    daemon.answers = true;
    daemon.packets = count_in(health.value("packets", nlohmann::json::object()), "received");
    daemon.silent_s = health.value("sensor_silent_s", 0.0);
    for (const auto& complaint : health.value("complaints", nlohmann::json::array()))
      daemon.complaints +=
          (daemon.complaints.empty() ? "" : ", ") + printable(complaint.get<std::string>());
  } catch (const std::runtime_error&) {  // none answers: that is the finding
  }
  return daemon;
}

Finding describe(const DoctorOptions& options, const Config& config) {
  return {Verdict::good, "Configuration",
          fmt::format("{}: packets on UDP {}, requests on {}", options.config, config.udp.data_port,
                      config.subscribe.port),
          ""};
}

std::vector<Finding> examine(const DoctorOptions& options, const Config& config) {
  const int priority = config.realtime.worker_priority;
  const doctor::Machine machine =
      doctor::read_machine(priority > 0 ? priority + 1 : 0, config.realtime.worker_cpu,
                           state_folder(config, options.config));
  const doctor::Wire wire = doctor::watch_wire(config.udp, options.seconds);
  const doctor::RunningDaemon daemon =
      wire.port_taken ? ask_daemon(config) : doctor::RunningDaemon();
  return {describe(options, config),
          check_card(config, machine),
          check_packets(config, machine, wire, daemon),
          check_firewall(config, machine, wire),
          check_receive_buffer(config, machine),
          check_priority(config, machine),
          check_memory_lock(config, machine),
          check_cpu(config, machine),
          check_clock(machine),
          check_disk(machine)};
}

void run_doctor(const DoctorOptions& options) {
  std::vector<Finding> findings;
  try {
    findings = examine(options, load_config(options.config));
  } catch (const ConfigError& error) {
    findings = {{Verdict::bad, "Configuration", error.what(), ""}};
  }
  fmt::print("{}", options.json ? to_json(findings) : to_text(findings, Paint(STDOUT_FILENO)));
  if (!is_ready(findings)) throw CLI::RuntimeError(1);  // the list says why
}

}  // namespace

void add_doctor_command(CLI::App& app) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* sub = app.add_subcommand(
      "doctor", "Check this computer before a drive: network, packets, clock, real time, disk");
  sub->footer("\nExit code: 0 ready, 1 something failed; warnings are no failure.");
  sub->add_option("CONFIG", options->config, "The YAML file lilod is to run with")->required();
  sub->add_option("--seconds", options->seconds, "How long to wait for packets")
      ->capture_default_str()
      ->check(above_zero());
  sub->add_flag("--json", options->json, "Print one JSON object");
  sub->callback([options] { run_doctor(*options); });
}

}  // namespace lilo
