// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/machine_checks.hpp"

#include <boost/asio/ip/address_v4.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <system_error>

namespace lilo::doctor {
namespace {

constexpr std::uint64_t kWantedFreeBytes = 200ULL << 20U;  // many maps and trajectories
constexpr const char* kUnitCure =
    "run it as the service (systemctl enable --now lilod), whose unit asks for it";

std::uint32_t parsed(const std::string& address) {
  boost::system::error_code error;
  const auto out = boost::asio::ip::make_address_v4(address, error);
  return error ? 0 : out.to_uint();
}

std::string with_mask(const Card& card) {
  return fmt::format("{} {}/{}{}", card.name, ipv4_text(card.ipv4), std::popcount(card.mask),
                     card.up ? "" : " (no link)");
}

std::string list_of(const std::vector<Card>& cards) {
  std::string text;
  for (const Card& card : cards) {
    if (!card.loopback) text += (text.empty() ? "" : ", ") + with_mask(card);
  }
  return text.empty() ? "loopback alone" : text;
}

Finding check_bound_card(std::uint32_t bound, const Machine& machine) {
  const auto card = std::find_if(machine.cards.begin(), machine.cards.end(),
                                 [&](const Card& each) { return each.ipv4 == bound; });
  if (card != machine.cards.end()) return {Verdict::good, "Network card", with_mask(*card), ""};
  return {Verdict::bad, "Network card",
          fmt::format("udp.bind_address {} is not this computer's, which has {}", ipv4_text(bound),
                      list_of(machine.cards)),
          "give the card that address, or set udp.bind_address to 0.0.0.0"};
}

Finding check_sensor_network(std::uint32_t sensor, const Machine& machine) {
  const auto card = std::find_if(machine.cards.begin(), machine.cards.end(), [&](const Card& each) {
    return (each.ipv4 & each.mask) == (sensor & each.mask);
  });
  if (card == machine.cards.end()) {
    return {Verdict::bad, "Network card",
            fmt::format("none is in the network of the sensor {}: {}", ipv4_text(sensor),
                        list_of(machine.cards)),
            fmt::format("ip address add {}/24 dev CARD", ipv4_text((sensor & 0xFFFFFF00U) | 100U))};
  }
  if (card->up) return {Verdict::good, "Network card", with_mask(*card), ""};
  return {Verdict::bad, "Network card", with_mask(*card), "plug the sensor in, and give it power"};
}

}  // namespace

Finding check_card(const Config& config, const Machine& machine) {
  const std::uint32_t bound = parsed(config.udp.bind_address);
  if (bound != 0) return check_bound_card(bound, machine);
  if (const std::uint32_t sensor = parsed(config.udp.sensor_address); sensor != 0)
    return check_sensor_network(sensor, machine);
  const bool any = std::any_of(machine.cards.begin(), machine.cards.end(),
                               [](const Card& card) { return card.up && !card.loopback; });
  return {any ? Verdict::good : Verdict::warning, "Network card", list_of(machine.cards),
          any ? "" : "give the card an address beside the sensor's, 192.168.1.201 by default"};
}

Finding check_receive_buffer(const Config& config, const Machine& machine) {
  const auto wanted = static_cast<std::uint64_t>(config.udp.receive_buffer_bytes);
  const std::string text =
      fmt::format("net.core.rmem_max {} kB, udp.receive_buffer_bytes wants {} kB",
                  machine.rmem_max_bytes / 1024, wanted / 1024);
  if (machine.rmem_max_bytes >= wanted) return {Verdict::good, "Socket buffer", text, ""};
  return {Verdict::warning, "Socket buffer", text + ": packets are lost when the computer is busy",
          fmt::format("sysctl -w net.core.rmem_max={}; and in /etc/sysctl.d/90-lilo.conf", wanted)};
}

Finding check_priority(const Config& config, const Machine& machine) {
  const int priority = config.realtime.worker_priority;
  if (priority == 0 || !machine.fifo_errno)
    return {Verdict::good, "Priority", "normal policy, as configured", ""};
  if (*machine.fifo_errno == 0) {
    return {Verdict::good, "Priority", fmt::format("SCHED_FIFO {} is granted", priority + 1), ""};
  }
  const std::string refused = fmt::format("SCHED_FIFO {} is refused to this user: {}", priority + 1,
                                          std::generic_category().message(*machine.fifo_errno));
  if (machine.unit_installed)
    return {Verdict::good, "Priority", refused + "; lilod.service asks for its own", ""};
  return {Verdict::warning, "Priority", refused, kUnitCure};
}

Finding check_memory_lock(const Config& config, const Machine& machine) {
  if (!config.realtime.lock_memory)
    return {Verdict::good, "Locked memory", "not wanted, as configured", ""};
  if (machine.memory_unlimited) return {Verdict::good, "Locked memory", "no limit", ""};
  if (machine.unit_installed)
    return {Verdict::good, "Locked memory", "limited for this user; not for lilod.service", ""};
  return {Verdict::warning, "Locked memory", "limited (ulimit -l)", kUnitCure};
}

Finding check_cpu(const Config& config, const Machine& machine) {
  const int cpu = config.realtime.worker_cpu;
  if (cpu >= machine.cpus) {
    return {Verdict::bad, "CPU",
            fmt::format("realtime.worker_cpu {} is not there: this computer has 0 to {}", cpu,
                        machine.cpus - 1),
            "set realtime.worker_cpu to one of these, or to -1"};
  }
  const std::string text =
      cpu < 0 ? fmt::format("any of {}", machine.cpus)
              : fmt::format("worker on CPU {}, isolated: {}", cpu,
                            machine.isolated_cpus.empty() ? "none" : machine.isolated_cpus);
  if (machine.governor != "powersave" && machine.governor != "ondemand")
    return {Verdict::good, "CPU", text, ""};
  return {Verdict::warning, "CPU",
          fmt::format("{}, governor {}: it is slow when a scan comes", text, machine.governor),
          "cpupower frequency-set -g performance"};
}

Finding check_clock(const Machine& machine) {
  const ClockState& clock = machine.clock;
  std::string by;
  for (const std::string& program : clock.programs) by += (by.empty() ? "" : ", ") + program;
  if (clock.synchronized) {
    return {Verdict::good, "Clock",
            fmt::format("synchronized within {:.1f} ms{}", clock.max_error_s * 1e3,
                        by.empty() ? "" : " by " + by),
            ""};
  }
  const std::string text = by.empty() ? "not synchronized, and nothing tries"
                                      : fmt::format("not synchronized (yet), {} tries", by);
  return {Verdict::warning, "Clock", text + ": stamps may be off by minutes",
          by.empty() ? "apt install chrony; or a GPS receiver on the sensor" : ""};
}

Finding check_disk(const Machine& machine) {
  const DiskState& disk = machine.disk;
  if (disk.folder.empty())
    return {Verdict::good, "Disk", "no state directory, so nothing is saved", ""};
  if (!disk.exists && !disk.hidden) {
    return {Verdict::warning, "Disk", fmt::format("{}: no such folder", disk.folder),
            "make it, for maps, trajectories and the calibration of an HDL-64E"};
  }
  const std::string text = fmt::format("{}: {} MB free", disk.folder, disk.free_bytes >> 20U);
  if (!disk.writable && !machine.unit_installed) {
    return {Verdict::warning, "Disk", text + ", but this user may not write there",
            "chown it to who runs lilod, or set state.directory"};
  }
  if (disk.free_bytes < kWantedFreeBytes)
    return {Verdict::warning, "Disk", text, "make room: a map takes some 10 MB"};
  return {Verdict::good, "Disk", text, ""};
}

}  // namespace lilo::doctor
