// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/terminal/paint.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace lilo {

/// What a daemon said of itself: datagrams of daemon/PROTOCOL.md.
struct StatusReport {
  std::string address, software;
  nlohmann::json health;  ///< the datagram
  nlohmann::json pose;    ///< the datagram of the last pose; null when there is none
};

/// One line of the screen, "label : text".
struct StatusRow {
  std::string label, text;
  Colour colour = Colour::none;
};

/// True when poses may be used: tracking, and nothing to complain of.
bool is_good(const StatusReport& report);

/// The screen, row by row. What this daemon does not say has no row.
std::vector<StatusRow> status_rows(const StatusReport& report);

/// As one screen.
std::string to_text(const StatusReport& report, const Paint& paint);
/// One row of it, with the line's end.
std::string to_text(const StatusRow& row, const Paint& paint);

/// One JSON object: good, lilod, software, health, pose.
std::string to_json(const StatusReport& report);

}  // namespace lilo
