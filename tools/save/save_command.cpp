// SPDX-License-Identifier: BSD-3-Clause
#include "tools/save/save_command.hpp"

#include "tools/cli.hpp"
#include "tools/connection/address_options.hpp"
#include "tools/terminal/printable.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace lilo {
namespace {

struct SaveOptions {
  LilodAddress address;
  std::string what;
};

void run_save(const SaveOptions& options) {
  constexpr std::chrono::seconds kDisk{30};
  Connection lilod(options.address);
  const nlohmann::json done = lilod.ask({{"save", options.what}}, "done", kDisk).at("done");
  fmt::print("{}: {} {}\n", printable(done.value("file", "")),
             done.value("count", std::uint64_t{0}), options.what == "map" ? "points" : "poses");
}

}  // namespace

void add_save_command(CLI::App& app) {
  auto options = std::make_shared<SaveOptions>();
  CLI::App* sub =
      app.add_subcommand("save", "Have lilod write its map or trajectory into its state directory");
  sub->add_option("WHAT", options->what, "map: the local map, PCD; trajectory: the session, TUM")
      ->check(one_of({"map", "trajectory"}))
      ->type_name("map|trajectory")
      ->required();
  add_address_options(*sub, options->address);
  sub->callback([options] { run_save(*options); });
}

}  // namespace lilo
