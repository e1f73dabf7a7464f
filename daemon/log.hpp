// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "daemon/event.hpp"

#include <string>
#include <string_view>

namespace lilo {

/// Sets spdlog's default logger up. Under systemd entries go to journald by its native protocol,
/// with PRIORITY=, INSTANCE=, SESSION=, STATUS= and for events MESSAGE_ID=; where that cannot be,
/// to stderr with the "<N>" prefixes journald turns into priorities; otherwise to stderr with the
/// time. At most 50 lines in 10 s; what is left out is counted in the next line that may be
/// written. Never waits for journald. Used by the main thread alone.
void start_log(LogLevel level, const std::string& instance);

/// May change at any time.
void set_log_level(LogLevel level);

/// The fields SESSION= and STATUS= of all entries from now on.
void set_log_context(std::string_view session, std::string_view status);

/// One line with the event's severity and MESSAGE_ID. Of one event six lines in a minute at most:
/// false when this was one too many, and nothing is written.
bool log_event(Event event, std::string_view text);

}  // namespace lilo
