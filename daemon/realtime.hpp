// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace lilo {

/// What the kernel says of a thread, read back and not remembered.
struct ThreadPolicy {
  std::string policy;  ///< "SCHED_OTHER", "SCHED_FIFO", ...
  int priority = 0;
  std::string cpus;  ///< "0-3,7"
};

/// What is in force after the start, and what the system refused.
struct RealtimeReport {
  ThreadPolicy receiver, worker, publisher;
  long locked_memory_kb = 0;
  std::vector<std::string> refusals;
};

/// Each of these returns why the system refused, in one line for the log, or nothing.
std::optional<std::string> pin_this_thread(int cpu);
std::optional<std::string> use_fifo_in_this_thread(int priority);
/// Always allowed.
void use_normal_policy_in_this_thread();
/// Locks our data and code, of libraries what is used, and all that will be mapped; keeps malloc
/// from giving memory back, and has it hold `reserve_bytes` more than it needs now. Call it before
/// there are other threads.
std::optional<std::string> lock_all_memory(std::size_t reserve_bytes);
std::optional<std::string> limit_stack_of_new_threads(std::size_t bytes);

ThreadPolicy policy_of_this_thread();

/// Of /proc/self/status: kilobytes that mlock holds in memory.
long locked_memory_kb();

}  // namespace lilo
