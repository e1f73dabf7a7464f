// SPDX-License-Identifier: BSD-3-Clause
#include "tools/status/status_command.hpp"

#include "tools/connection/address_options.hpp"
#include "tools/status/read_status.hpp"

#include <fmt/format.h>

#include <memory>
#include <unistd.h>

namespace lilo {
namespace {

struct StatusOptions {
  LilodAddress address;
  bool json = false;
};

void run_status(const StatusOptions& options) {
  Connection lilod(options.address);
  const StatusReport report = read_status(lilod);
  fmt::print("{}", options.json ? to_json(report) : to_text(report, Paint(STDOUT_FILENO)));
  if (!is_good(report)) throw CLI::RuntimeError(1);  // the screen says why
}

}  // namespace

void add_status_command(CLI::App& app) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* sub = app.add_subcommand("status", "How a running lilod is, on one screen");
  sub->footer("\nExit code: 0 tracking without complaints, 1 anything else or no answer.");
  add_address_options(*sub, options->address);
  sub->add_flag("--json", options->json, "Print one JSON object");
  sub->callback([options] { run_status(*options); });
}

}  // namespace lilo
