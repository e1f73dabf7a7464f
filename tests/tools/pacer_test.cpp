// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/pacer.hpp"

#include <gtest/gtest.h>

namespace lilo {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Pacer, KeepsTheCapturesDistances) {
  Pacer pacer(1.0, 5000 * kMs);
  EXPECT_EQ(pacer.due_ns(100 * kMs), 5000 * kMs);
  EXPECT_EQ(pacer.due_ns(101 * kMs), 5001 * kMs);
  EXPECT_EQ(pacer.due_ns(250 * kMs), 5150 * kMs);
}

TEST(Pacer, WaitsForAMinuteButNotForAClockThatWasSet) {
  Pacer pacer(1.0, 0);
  (void)pacer.due_ns(0);
  EXPECT_EQ(pacer.due_ns(60'000 * kMs), 60'000 * kMs);
  EXPECT_EQ(pacer.due_ns(3'660'000 * kMs), 60'000 * kMs);
  EXPECT_EQ(pacer.due_ns(3'660'005 * kMs), 60'005 * kMs);
}

TEST(Pacer, DividesThemByTheSpeed) {
  Pacer pacer(4.0, 0);
  (void)pacer.due_ns(0);
  EXPECT_EQ(pacer.due_ns(100 * kMs), 25 * kMs);
}

TEST(Pacer, DoesNotDriftOverAnHour) {
  Pacer pacer(1.0, 0);
  std::int64_t due = 0, captured = 0;
  for (int k = 0; k < 3'600'000; ++k) due = pacer.due_ns(captured += 1'327'104);
  EXPECT_EQ(due, captured - 1'327'104);
}

TEST(Pacer, SwappedStampsDoNotShiftTheSchedule) {
  Pacer pacer(1.0, 0);
  (void)pacer.due_ns(0);
  (void)pacer.due_ns(20 * kMs);
  EXPECT_EQ(pacer.due_ns(19 * kMs), 19 * kMs);
  EXPECT_EQ(pacer.due_ns(30 * kMs), 30 * kMs);
}

TEST(Pacer, GoesOnWhereItIsWhenStampsStartAgain) {
  Pacer pacer(1.0, 0);
  (void)pacer.due_ns(50'000 * kMs);
  (void)pacer.due_ns(60'000 * kMs);
  EXPECT_EQ(pacer.due_ns(50'000 * kMs), 10'000 * kMs);
  EXPECT_EQ(pacer.due_ns(50'005 * kMs), 10'005 * kMs);
}

TEST(Pacer, RestartsShortFilesToo) {
  Pacer pacer(1.0, 0);
  (void)pacer.due_ns(0);
  (void)pacer.due_ns(300 * kMs);
  pacer.restart();
  EXPECT_EQ(pacer.due_ns(0), 300 * kMs);
  EXPECT_EQ(pacer.due_ns(1 * kMs), 301 * kMs);
}

}  // namespace
}  // namespace lilo
