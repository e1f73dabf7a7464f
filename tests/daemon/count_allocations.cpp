// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <dlfcn.h>
#include <pthread.h>

/// For LD_PRELOAD: counts the allocations of every thread by its name, from COUNT_FROM_S to
/// COUNT_TO_S seconds after the start, and prints them at the end of the program.
namespace {

struct Thread {
  std::array<char, 16> name{};
  std::atomic<long> allocations{0};
};

constexpr std::size_t kThreads = 32;
std::array<Thread, kThreads> threads;
std::atomic<std::size_t> thread_count{0};

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before main()
  return value == nullptr ? 0.0 : std::atof(value);
}

const double began_s = now_s();
const double from_s = seconds_of("COUNT_FROM_S"), to_s = seconds_of("COUNT_TO_S");

void count() {
  const double age_s = now_s() - began_s;
  if (began_s == 0.0 || age_s < from_s || age_s >= to_s) return;
  thread_local Thread* mine = nullptr;  // named long before we look
  if (mine == nullptr) {
    const std::size_t k = thread_count++;
    if (k >= kThreads) return;
    mine = &threads[k];
    pthread_getname_np(pthread_self(), mine->name.data(), mine->name.size());
  }
  ++mine->allocations;
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

struct Printer {
  ~Printer() {
    for (const Thread& thread : threads) {
      if (thread.allocations > 0)
        std::fprintf(stderr, "allocations of %s: %ld\n", thread.name.data(),
                     thread.allocations.load());
    }
  }
} printer;

}  // namespace

extern "C" {

void* malloc(std::size_t size) {
  static const auto real = next<void* (*)(std::size_t)>("malloc");
  count();
  return real(size);
}

void* realloc(void* ptr, std::size_t size) {
  static const auto real = next<void* (*)(void*, std::size_t)>("realloc");
  count();
  return real(ptr, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  static const auto real = next<void* (*)(std::size_t, std::size_t)>("aligned_alloc");
  count();
  return real(alignment, size);
}

int posix_memalign(void** memptr, std::size_t alignment, std::size_t size) {
  static const auto real = next<int (*)(void**, std::size_t, std::size_t)>("posix_memalign");
  count();
  return real(memptr, alignment, size);
}
}
