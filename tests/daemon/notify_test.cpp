// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/lilod_fixture.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace lilo {
namespace {

// systemd may be busy: here it reads nothing for long enough that its socket fills up (ten messages
// by default). The daemon must go on publishing, and stop when asked.
TEST(Notify, NeverWaitsForSystemd) {
  Lilod lilod("", {{"WATCHDOG_USEC", "20000"}});
  ASSERT_TRUE(lilod.wait_ready());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(lilod.stop(), 0) << lilod.process().standard_error();
}

// A silent sensor is no reason to be restarted: the watchdog is fed.
TEST(Notify, WatchdogIsFedWhileTheSensorIsSilent) {
  Lilod lilod("", {{"WATCHDOG_USEC", "200000"}});
  ASSERT_TRUE(lilod.wait_ready());
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(lilod.systemd().wait_for("WATCHDOG=1", std::chrono::seconds(10)));
  }
}

TEST(Notify, NoWatchdogNobodyAskedFor) {
  Lilod lilod("", {{"WATCHDOG_USEC", "20000"}, {"WATCHDOG_PID", "1"}});
  ASSERT_TRUE(lilod.wait_ready());
  EXPECT_FALSE(lilod.systemd().wait_for("WATCHDOG=1", std::chrono::milliseconds(200)));
}

}  // namespace
}  // namespace lilo
