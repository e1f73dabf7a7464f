// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

/// sd_notify(3) in words. libsystemd's own call waits while systemd does not read, and with it
/// would wait the thread that publishes poses; these never wait, but for ready(), nor do they
/// allocate. Each does nothing when systemd did not start us.
namespace lilo::notify {

void ready(std::string_view status);
void status(std::string_view status);
void reloading();
void stopping();
void watchdog();

/// How often systemd wants to hear from us; 0: it does not care.
std::int64_t watchdog_interval_us();

}  // namespace lilo::notify
