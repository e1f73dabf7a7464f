// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace lilo {

/// A value that one thread stores and others copy, all of it of one instant. Neither side waits,
/// locks or allocates: a copy that was overtaken by a store is given up. (A sequence lock as in
/// Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012.)
template <typename T>
class Snapshot {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Snapshot() { store(T{}); }

  /// One thread.
  void store(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint64_t begun = sequence_.load(std::memory_order_relaxed) + 1;
    sequence_.store(begun, std::memory_order_relaxed);
    for (std::size_t k = 0; k < kWords; ++k) words_[k].store(words[k], std::memory_order_release);
    sequence_.store(begun + 1, std::memory_order_release);
  }

  /// Any thread. False, and `value` is as it was, when a store came in between.
  bool load(T& value) const noexcept {
    const std::uint64_t before = sequence_.load(std::memory_order_acquire);
    std::array<std::uint64_t, kWords> words{};
    for (std::size_t k = 0; k < kWords; ++k) words[k] = words_[k].load(std::memory_order_acquire);
    if (before % 2 != 0 || sequence_.load(std::memory_order_relaxed) != before) return false;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return true;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  std::atomic<std::uint64_t> sequence_{0};  // odd while a store is under way
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace lilo
