#pragma once

namespace lilo {

/// Sets spdlog's default logger up on stderr: under systemd with the "<N>" prefixes journald turns
/// into priorities, otherwise with the time. Never called by the receiver or the worker.
void start_log();

}  // namespace lilo
