// SPDX-License-Identifier: BSD-3-Clause
#include "tools/reset/reset_command.hpp"

#include "tools/cli.hpp"
#include "tools/connection/address_options.hpp"
#include "tools/reset/reset_request.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace lilo {
namespace {

struct ResetOptions {
  LilodAddress address;
  std::vector<double> pose;
};

void run_reset(const ResetOptions& options) {
  Connection lilod(options.address);
  (void)lilod.ask(reset_request(options.pose), "done");
  fmt::print("{}: the next scan begins a new session\n", to_string(options.address));
}

}  // namespace

void add_reset_command(CLI::App& app) {
  auto options = std::make_shared<ResetOptions>();
  CLI::App* sub = app.add_subcommand("reset", "Have lilod begin a new session");
  add_address_options(*sub, options->address);
  sub->add_option("--pose", options->pose,
                  "Where it begins: X Y Z in m, or also ROLL PITCH YAW in degrees; default: zero")
      ->expected(3, 6)
      ->type_name("NUMBER")
      ->check(within(-1e7, 1e7));
  sub->callback([options] { run_reset(*options); });
}

}  // namespace lilo
