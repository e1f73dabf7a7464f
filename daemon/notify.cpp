#include "daemon/notify.hpp"

#include "daemon/clock.hpp"

#include <systemd/sd-daemon.h>

namespace lilo::notify {

void ready(const std::string& status) { sd_notify(0, ("READY=1\nSTATUS=" + status).c_str()); }

void status(const std::string& status) { sd_notify(0, ("STATUS=" + status).c_str()); }

void reloading() {
  const std::string now = std::to_string(monotonic_ns() / 1000);
  sd_notify(0, ("RELOADING=1\nMONOTONIC_USEC=" + now).c_str());
}

void stopping() { sd_notify(0, "STOPPING=1"); }

void watchdog() { sd_notify(0, "WATCHDOG=1"); }

std::int64_t watchdog_interval_us() {
  std::uint64_t interval = 0;
  return sd_watchdog_enabled(0, &interval) > 0 ? static_cast<std::int64_t>(interval) : 0;
}

}  // namespace lilo::notify
