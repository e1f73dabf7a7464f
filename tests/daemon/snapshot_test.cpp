// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/snapshot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace lilo {
namespace {

// All numbers of a copy are of one store.
TEST(Snapshot, IsNeverHalfOfTwo) {
  using Numbers = std::array<std::uint64_t, 40>;
  Snapshot<Numbers> snapshot;
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    Numbers numbers{};
    for (std::uint64_t k = 1; !stop; ++k) {
      numbers.fill(k);
      snapshot.store(numbers);
    }
  });
  Numbers seen{};
  int copies = 0;
  std::uint64_t last = 0;
  while (copies < 10'000 || last < 100) {
    if (!snapshot.load(seen)) continue;
    ++copies;
    ASSERT_EQ(std::count(seen.begin(), seen.end(), seen[0]), 40);
    ASSERT_GE(seen[0], last);
    last = seen[0];
  }
  stop = true;
  writer.join();
}

}  // namespace
}  // namespace lilo
