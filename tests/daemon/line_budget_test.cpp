// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/line_budget.hpp"

#include <gtest/gtest.h>

namespace lilo {
namespace {

TEST(LineBudget, RefusesAndCountsUntilTheTimeIsOver) {
  LineBudget budget(3, 1000);
  int written = 0;
  for (std::int64_t now = 5000; now < 6000; now += 100) written += budget.take(now) ? 1 : 0;
  EXPECT_EQ(written, 3);
  EXPECT_TRUE(budget.take(6000));
  EXPECT_EQ(budget.take_left_out(), 7U);
  EXPECT_EQ(budget.take_left_out(), 0U);
  EXPECT_TRUE(budget.take(9000));
  EXPECT_EQ(budget.take_left_out(), 0U);
}

}  // namespace
}  // namespace lilo
