#pragma once

#include "config/config.hpp"

namespace lilo {

/// Sets spdlog's default logger up on stderr: under systemd with the "<N>" prefixes journald turns
/// into priorities, otherwise with the time. At most 50 lines in 10 s; what is left out is counted
/// in the next line that may be written. Used by the main thread alone.
void start_log(LogLevel level);

/// May change at any time.
void set_log_level(LogLevel level);

}  // namespace lilo
