// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

namespace lilo {

/// Lock-free ring for one producer and one consumer thread, with slots that are built once and
/// written in place. The indices are ever-growing counters; each side keeps a copy of the other's
/// counter and reloads it only when the ring seems full or empty, so that in the steady state the
/// two threads touch no common cache line.
///
/// Producer: reserve() -> write -> commit().  Consumer: front() -> read -> release().
template <typename T>
class SpscRing {
 public:
  /// `slots` default-built slots; for_each_slot() is where their memory is reserved.
  explicit SpscRing(std::size_t slots) : slots_(slots) {}
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  /// Before the threads start: run `prepare(T&)` on every slot, to reserve and touch its memory.
  template <typename Prepare>
  void for_each_slot(Prepare&& prepare) {
    for (T& slot : slots_) prepare(slot);
  }

  /// Producer. The slot to write, or nullptr when the ring is full. Repeats until commit().
  [[nodiscard]] T* reserve() noexcept {
    const std::size_t written = written_.load(std::memory_order_relaxed);
    if (written - released_seen_ == slots_.size()) {
      released_seen_ = released_.load(std::memory_order_acquire);
      if (written - released_seen_ == slots_.size()) return nullptr;
    }
    return &slots_[written % slots_.size()];
  }

  /// Producer. Hands the reserved slot to the consumer.
  void commit() noexcept {
    written_.store(written_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  /// Consumer. The oldest slot, or nullptr when the ring is empty. Repeats until release().
  [[nodiscard]] T* front() noexcept {
    const std::size_t released = released_.load(std::memory_order_relaxed);
    // Beyond it: slots were released without a look at them.
    if (released >= written_seen_) {
      written_seen_ = written_.load(std::memory_order_acquire);
      if (released == written_seen_) return nullptr;
    }
    return &slots_[released % slots_.size()];
  }

  /// Consumer. Gives the oldest slot back to the producer; without front(), only while size() says
  /// that there is one.
  void release() noexcept {
    released_.store(released_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  /// Any thread: slots committed and not yet released; exact only when both sides rest.
  [[nodiscard]] std::size_t size() const noexcept {
    const std::size_t released = released_.load(std::memory_order_acquire);
    return written_.load(std::memory_order_acquire) - released;
  }
  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

 private:
  static constexpr std::size_t kCacheLine = 64;

  std::vector<T> slots_;
  alignas(kCacheLine) std::atomic<std::size_t> written_{0};
  std::size_t released_seen_ = 0;  // the producer's copy
  alignas(kCacheLine) std::atomic<std::size_t> released_{0};
  std::size_t written_seen_ = 0;  // the consumer's copy
  static_assert(std::atomic<std::size_t>::is_always_lock_free);
};

}  // namespace lilo
