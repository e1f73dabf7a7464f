// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/machine.hpp"

#include <boost/asio/ip/address_v4.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <thread>
#include <unistd.h>

namespace lilo::doctor {
namespace {

namespace fs = std::filesystem;

/// The first line of a file of the kernel's; empty where there is none.
std::string line_of(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::uint64_t number_of(const fs::path& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  file >> number;
  return number;
}

std::uint32_t ipv4_of(const sockaddr* address) {
  sockaddr_in in{};
  if (address != nullptr) std::memcpy(&in, address, sizeof(in));
  return ntohl(in.sin_addr.s_addr);
}

/// The kernel takes the larger of a card's own setting and that for all.
int rp_filter_of(const std::string& card) {
  const fs::path folder = "/proc/sys/net/ipv4/conf";
  return static_cast<int>(
      std::max(number_of(folder / card / "rp_filter"), number_of(folder / "all" / "rp_filter")));
}

std::vector<Card> read_cards() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, freeifaddrs);
  std::vector<Card> cards;
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    cards.push_back({.name = each->ifa_name,
                     .ipv4 = ipv4_of(each->ifa_addr),
                     .mask = ipv4_of(each->ifa_netmask),
                     .up = (each->ifa_flags & IFF_RUNNING) != 0U,
                     .loopback = (each->ifa_flags & IFF_LOOPBACK) != 0U,
                     .rp_filter = rp_filter_of(each->ifa_name)});
  }
  return cards;
}

bool ufw_is_on() {
  std::ifstream file("/etc/ufw/ufw.conf");
  for (std::string line; std::getline(file, line);) {
    if (line == "ENABLED=yes") return true;
  }
  return false;
}

std::vector<std::string> running_programs() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos)
      names.push_back(line_of(entry.path() / "comm"));
  }
  return names;
}

bool has(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::vector<std::string> read_firewalls(const std::vector<std::string>& programs) {
  std::vector<std::string> names;
  if (ufw_is_on()) names.emplace_back("ufw");
  if (has(programs, "firewalld")) names.emplace_back("firewalld");
  if (names.empty() && fs::exists("/sys/module/nf_tables")) names.emplace_back("nftables");
  return names;
}

ClockState read_clock(const std::vector<std::string>& programs) {
  timex state{};
  const int result = ntp_adjtime(&state);
  ClockState clock{.synchronized = result != TIME_ERROR && result >= 0 &&
                                   (static_cast<unsigned>(state.status) & STA_UNSYNC) == 0U,
                   .max_error_s = static_cast<double>(state.maxerror) * 1e-6};
  // As the kernel cuts them, to 15 characters.
  for (const char* name : {"chronyd", "ntpd", "systemd-timesyn", "ptp4l", "phc2sys"}) {
    if (has(programs, name)) clock.programs.emplace_back(name);
  }
  return clock;
}

/// Of a thread of its own, which ends at once.
int try_fifo(int priority) {
  int error = 0;
  std::thread([&] {
    const sched_param parameters{.sched_priority = priority};
    error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  }).join();
  return error;
}

bool memory_is_unlimited() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  return limit.rlim_cur == RLIM_INFINITY;
}

bool unit_is_installed() {
  constexpr std::array<const char*, 3> kFolders{"/etc/systemd/system", "/lib/systemd/system",
                                                "/usr/lib/systemd/system"};
  return std::any_of(kFolders.begin(), kFolders.end(), [](const char* folder) {
    return fs::exists(fs::path(folder) / "lilod.service");
  });
}

DiskState read_disk(const std::string& folder) {
  DiskState disk{.folder = folder};
  if (folder.empty()) return disk;
  std::error_code error;
  disk.exists = fs::is_directory(folder, error);
  disk.hidden = error == std::errc::permission_denied;
  disk.writable = access(folder.c_str(), W_OK | X_OK) == 0;
  const std::string looked_at = disk.hidden ? fs::path(folder).parent_path().string() : folder;
  struct statvfs space {};
  if (statvfs(looked_at.c_str(), &space) == 0) disk.free_bytes = space.f_bavail * space.f_frsize;
  return disk;
}

std::string governor_of(int cpu) {
  const std::string name = "cpu" + std::to_string(std::max(cpu, 0));
  return line_of(fs::path("/sys/devices/system/cpu") / name / "cpufreq/scaling_governor");
}

}  // namespace

Machine read_machine(int priority, int cpu, const std::string& state_folder) {
  const std::vector<std::string> programs = running_programs();
  Machine machine{.cards = read_cards(),
                  .firewalls = read_firewalls(programs),
                  .rmem_max_bytes = number_of("/proc/sys/net/core/rmem_max"),
                  .cpus = static_cast<int>(std::thread::hardware_concurrency()),
                  .governor = governor_of(cpu),
                  .isolated_cpus = line_of("/sys/devices/system/cpu/isolated"),
                  .memory_unlimited = memory_is_unlimited(),
                  .unit_installed = unit_is_installed(),
                  .clock = read_clock(programs),
                  .disk = read_disk(state_folder)};
  if (priority > 0) machine.fifo_errno = try_fifo(priority);
  return machine;
}

std::string ipv4_text(std::uint32_t ipv4) { return boost::asio::ip::address_v4(ipv4).to_string(); }

}  // namespace lilo::doctor
