// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/connection/connection.hpp"

#include <CLI/CLI.hpp>

namespace lilo {

/// --host and --port of the commands that talk to a daemon.
inline void add_address_options(CLI::App& sub, LilodAddress& address) {
  sub.add_option("--host", address.host, "Computer that lilod runs on: a name or an address")
      ->capture_default_str();
  sub.add_option("--port", address.port, "Its subscribe.port")->capture_default_str();
}

}  // namespace lilo
