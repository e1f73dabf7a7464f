// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/realtime.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <system_error>

namespace lilo {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

std::string cpu_list(const cpu_set_t& set) {
  std::string out;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &set)) continue;
    const int first = cpu;
    while (cpu + 1 < CPU_SETSIZE && CPU_ISSET(cpu + 1, &set)) ++cpu;
    if (!out.empty()) out += ',';
    out += first == cpu ? fmt::format("{}", cpu) : fmt::format("{}-{}", first, cpu);
  }
  return out;
}

const char* policy_name(int policy) {
  switch (policy) {
    case SCHED_OTHER:
      return "SCHED_OTHER";
    case SCHED_FIFO:
      return "SCHED_FIFO";
    case SCHED_RR:
      return "SCHED_RR";
    case SCHED_BATCH:
      return "SCHED_BATCH";
    case SCHED_IDLE:
      return "SCHED_IDLE";
    default:
      return "unknown";
  }
}

// Takes all pages of our data and our code now. Of libraries' code only what runs is taken, and
// then stays: 40 MB of what the robot never calls are not worth their memory.
void lock_what_we_use() {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    void *begin = nullptr, *end = nullptr;
    std::array<char, 5> access{};
    if (std::sscanf(line.c_str(), "%p-%p %4s", &begin, &end, access.data()) != 3) continue;
    const bool data = access[0] == 'r' && access[1] == 'w';
    const auto bytes = static_cast<char*>(end) - static_cast<char*>(begin);
    if (data || line.ends_with(program)) mlock(begin, static_cast<std::size_t>(bytes));
  }
}

}  // namespace

// The pthread functions return the error; they do not set errno, and they are never negative.

std::optional<std::string> pin_this_thread(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
  if (error == 0) return std::nullopt;
  return fmt::format("cannot pin to cpu {}: {}", cpu, reason(error));
}

std::optional<std::string> use_fifo_in_this_thread(int priority) {
  const sched_param parameters{.sched_priority = priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0) return std::nullopt;
  return fmt::format("cannot use SCHED_FIFO priority {}: {} (LimitRTPRIO= or CAP_SYS_NICE)",
                     priority, reason(error));
}

void use_normal_policy_in_this_thread() {
  const sched_param parameters{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameters);
}

std::optional<std::string> lock_all_memory(std::size_t reserve_bytes) {
  // Memory that went back to the kernel would fault when it is asked for again. One heap for all
  // threads, because a thread's own grows by page faults even when the future is locked; and in
  // large steps, because the kernel fills each step as a whole.
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TOP_PAD, 1 << 20);
  if (mlockall(MCL_CURRENT | MCL_ONFAULT) == 0 && mlockall(MCL_FUTURE) == 0) {
    lock_what_we_use();
    // Locked and given back to malloc, which keeps it: the heap grows here and not at work.
    void* volatile reserve = std::malloc(reserve_bytes);  // volatile: or the pair is optimised away
    std::free(reserve);
    return std::nullopt;
  }
  return fmt::format("cannot lock memory: {} (LimitMEMLOCK= or CAP_IPC_LOCK)", reason(errno));
}

std::optional<std::string> limit_stack_of_new_threads(std::size_t bytes) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, bytes);
  const int error = pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  if (error == 0) return std::nullopt;
  return fmt::format("cannot set a stack of {} bytes: {}", bytes, reason(error));
}

ThreadPolicy policy_of_this_thread() {
  ThreadPolicy out;
  int policy = 0;
  sched_param parameters{};
  if (pthread_getschedparam(pthread_self(), &policy, &parameters) == 0) {
    out.policy = policy_name(policy);
    out.priority = parameters.sched_priority;
  }
  cpu_set_t set;
  CPU_ZERO(&set);
  if (pthread_getaffinity_np(pthread_self(), sizeof(set), &set) == 0) out.cpus = cpu_list(set);
  return out;
}

long locked_memory_kb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    long kb = 0;
    if (word == "VmLck:" && status >> kb) return kb;
  }
  return 0;
}

}  // namespace lilo
