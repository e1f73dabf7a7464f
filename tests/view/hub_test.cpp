// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/hub.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lilo::view {
namespace {

TEST(Hub, KeepsDatagramsAndWakesMembers) {
  Hub hub(1U << 20U);
  int woken = 0;
  const std::uint64_t member = hub.join([&] { ++woken; });
  hub.take(R"({"v":"2.0","pose":{}})");
  hub.take("no JSON");
  hub.take("[1]");
  hub.take(R"({"hello":{}})");
  hub.take("{\"pose\":\n{}}");
  hub.tell({{"mode", "live"}});
  EXPECT_EQ(woken, 3);
  EXPECT_EQ(hub.malformed(), 2U);
  hub.leave(member);
  hub.take(R"({"health":{}})");
  EXPECT_EQ(woken, 3);
  std::string text;
  hub.log().read_after(0, 1U << 20U, text);
  EXPECT_EQ(text,
            "{\"v\":\"2.0\",\"pose\":{}}\n{\"pose\":{}}\n{\"view\":{\"mode\":\"live\"}}\n"
            "{\"health\":{}}\n")
      << "a line each, whatever came";
}

}  // namespace
}  // namespace lilo::view
