// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/realtime.hpp"

#include <gtest/gtest.h>

#include <sched.h>
#include <thread>

namespace lilo {
namespace {

// Affinity and policy belong to the thread, so each test has its own.
template <typename Body>
void in_a_thread(Body body) {
  std::thread(body).join();
}

TEST(Realtime, PinIsReadBack) {
  in_a_thread([] {
    const int cpu = sched_getcpu();
    ASSERT_FALSE(pin_this_thread(cpu).has_value());
    EXPECT_EQ(policy_of_this_thread().cpus, std::to_string(cpu));
  });
}

TEST(Realtime, RefusedPinSaysWhy) {
  in_a_thread([] {
    const std::string before = policy_of_this_thread().cpus;
    const auto refusal = pin_this_thread(1000);
    ASSERT_TRUE(refusal.has_value());
    EXPECT_EQ(*refusal, "cannot pin to cpu 1000: Invalid argument");
    EXPECT_EQ(policy_of_this_thread().cpus, before);
  });
}

// Granted or refused, what is reported is what the kernel says.
TEST(Realtime, FifoIsInForceOrRefused) {
  in_a_thread([] {
    const auto refusal = use_fifo_in_this_thread(7);
    const ThreadPolicy policy = policy_of_this_thread();
    EXPECT_EQ(policy.policy, refusal ? "SCHED_OTHER" : "SCHED_FIFO");
    EXPECT_EQ(policy.priority, refusal ? 0 : 7);
    EXPECT_EQ(sched_getscheduler(0), refusal ? SCHED_OTHER : SCHED_FIFO);
    use_normal_policy_in_this_thread();
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
  });
}

TEST(Realtime, ImpossiblePriorityIsRefused) {
  in_a_thread([] {
    const auto refusal = use_fifo_in_this_thread(100);
    ASSERT_TRUE(refusal.has_value());
    EXPECT_NE(refusal->find("Invalid argument"), std::string::npos) << *refusal;
  });
}

}  // namespace
}  // namespace lilo
