// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/confirmation.hpp"

#include <gtest/gtest.h>

namespace lilo::core {
namespace {

void add(Confirmation& confirmation, bool is_good, int scans) {
  for (int k = 0; k < scans; ++k) confirmation.add(is_good);
}

TEST(Confirmation, TakesGoodScansInARow) {
  Confirmation confirmation;
  add(confirmation, true, tracking::kScansToConfirm - 1);
  confirmation.add(false);
  add(confirmation, true, tracking::kScansToConfirm - 1);
  EXPECT_FALSE(confirmation.is_confirmed()) << "the bad one between them begins another row";
  confirmation.add(true);
  EXPECT_TRUE(confirmation.is_confirmed());
}

TEST(Confirmation, OutlastsSingleBadScans) {
  Confirmation confirmation;
  confirmation.confirm();
  for (int k = 0; k < 10; ++k) {
    add(confirmation, false, tracking::kScansToDoubt - 1);
    EXPECT_TRUE(confirmation.is_confirmed());
    confirmation.add(true);
  }
  add(confirmation, false, tracking::kScansToDoubt);
  EXPECT_FALSE(confirmation.is_confirmed());
}

}  // namespace
}  // namespace lilo::core
