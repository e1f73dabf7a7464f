#pragma once

#include <cstdint>
#include <string>

/// sd_notify(3) in words. libsystemd's own call waits while systemd does not read, and with it
/// would wait the thread that publishes poses; these never wait, but for ready(). Each does nothing
/// when systemd did not start us.
namespace lilo::notify {

void ready(const std::string& status);
void status(const std::string& status);
void reloading();
void stopping();
void watchdog();

/// How often systemd wants to hear from us; 0: it does not care.
std::int64_t watchdog_interval_us();

}  // namespace lilo::notify
