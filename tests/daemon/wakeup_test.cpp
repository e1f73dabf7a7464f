// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/wakeup.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace lilo {
namespace {

TEST(Wakeup, SignalsBeforeTheWaitAreNotLost) {
  Wakeup wakeup(Wakeup::Mode::blocking);
  wakeup.signal();
  wakeup.signal();
  wakeup.wait();  // hangs, and ctest ends it, if a signal was lost
  SUCCEED();
}

TEST(Wakeup, PolledNeverWaits) {
  Wakeup wakeup(Wakeup::Mode::polled);
  wakeup.wait();
  wakeup.signal();
  wakeup.wait();
  wakeup.wait();
  SUCCEED();
}

// Ping-pong: every value the one side wrote is seen by the other.
TEST(Wakeup, OrdersTwoThreads) {
  constexpr int kRounds = 2000;
  Wakeup ping(Wakeup::Mode::blocking), pong(Wakeup::Mode::blocking);
  std::atomic<int> value{0};
  std::thread other([&] {
    for (int k = 0; k < kRounds; ++k) {
      ping.wait();
      value.store(value.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      pong.signal();
    }
  });
  for (int k = 0; k < kRounds; ++k) {
    ping.signal();
    pong.wait();
    EXPECT_EQ(value.load(std::memory_order_relaxed), k + 1);
  }
  other.join();
}

}  // namespace
}  // namespace lilo
