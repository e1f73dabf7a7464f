// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lilo::doctor {

/// A network card with an IPv4 address.
struct Card {
  std::string name;
  std::uint32_t ipv4 = 0, mask = 0;  ///< host byte order
  bool up = false, loopback = false;
  int rp_filter = 0;  ///< 1: the kernel drops senders it would not answer through this card
};

struct ClockState {
  bool synchronized = false;
  double max_error_s = 0.0;           ///< the kernel's bound
  std::vector<std::string> programs;  ///< chronyd, ptp4l, ... that run
};

struct DiskState {
  std::string folder;
  bool exists = false;
  bool hidden = false;  ///< systemd's, of a dynamic user: nobody else may look inside
  bool writable = false;
  std::uint64_t free_bytes = 0;
};

/// What the checks want to know of this computer. Read without root's rights.
struct Machine {
  std::vector<Card> cards;
  std::vector<std::string> firewalls;  ///< that are switched on, by name
  std::uint64_t rmem_max_bytes = 0;
  int cpus = 0;
  std::string governor;           ///< of the worker's CPU; empty: unknown
  std::string isolated_cpus;      ///< the kernel's list
  std::optional<int> fifo_errno;  ///< 0: SCHED_FIFO of the worker's priority was granted
  bool memory_unlimited = false;  ///< RLIMIT_MEMLOCK
  bool unit_installed = false;    ///< lilod.service, which sets its own limits
  ClockState clock;
  DiskState disk;
};

/// `priority`: to be tried, 0: not at all; `cpu`: the worker's, -1: none; `state_folder` may be
/// empty.
Machine read_machine(int priority, int cpu, const std::string& state_folder);

/// "192.168.1.77"
std::string ipv4_text(std::uint32_t ipv4);

}  // namespace lilo::doctor
