// SPDX-License-Identifier: BSD-3-Clause
#include "tools/status/read_status.hpp"

#include <stdexcept>

namespace lilo {

StatusReport read_status(Connection& lilod) {
  StatusReport report{.address = to_string(lilod.address()), .software = lilod.software()};
  report.health = lilod.ask({{"query", "health"}}, "health");
  try {
    report.pose = lilod.ask({{"query", "pose"}}, "pose");
  } catch (const std::runtime_error&) {  // it has none yet
    report.pose = nullptr;
  }
  return report;
}

}  // namespace lilo
