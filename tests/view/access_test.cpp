// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/access.hpp"

#include <gtest/gtest.h>

namespace lilo::view {
namespace {

TEST(Access, OnLoopbackOurNamesAlone) {
  const Access access(false, {});
  for (const char* ours : {"localhost:8080", "127.0.0.1:8080", "127.0.0.1", "[::1]:8080"})
    EXPECT_TRUE(access.may_read(ours, "", "")) << ours;
  for (const char* other : {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example",
                            "localhost.evil.example:8080", "[::1].evil", "[::2]:8080"})
    EXPECT_FALSE(access.may_read(other, "", "")) << other;
}

TEST(Access, AStreamIsForPagesOfOurOwn) {
  const Access access(false, {"https://app.foxglove.dev"});
  EXPECT_TRUE(access.is_origin_good("", "127.0.0.1:8080")) << "no browser";
  EXPECT_TRUE(access.is_origin_good("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(access.is_origin_good("https://app.foxglove.dev", "127.0.0.1:8080"));
  for (const char* other : {"null", "http://evil.example", "http://127.0.0.1:9", "file://",
                            "https://app.foxglove.dev.evil.example"})
    EXPECT_FALSE(access.is_origin_good(other, "127.0.0.1:8080")) << other;
}

TEST(Access, ALinkWorksOnce) {
  Access access(true, {});
  EXPECT_FALSE(access.may_read("127.0.0.1", "", "")) << "the address is no proof";
  EXPECT_FALSE(access.may_read("robot", "lilo_view=", ""));
  const std::string key = access.new_key();
  EXPECT_TRUE(access.redeem("guess").empty());
  EXPECT_TRUE(access.redeem("").empty());
  const std::string cookie = access.redeem(key);
  EXPECT_EQ(cookie.size(), 32U);
  EXPECT_TRUE(access.redeem(key).empty());
  EXPECT_TRUE(access.may_read("robot:8080", "a=b; lilo_view=" + cookie + "; c=d", ""));
  EXPECT_FALSE(access.may_read("robot:8080", "lilo_view=" + key, ""));
  EXPECT_TRUE(access.may_read("robot:8080", "", access.lasting_key()));
  EXPECT_FALSE(access.may_read("robot:8080", "", key));
}

TEST(Access, SecretsDiffer) {
  EXPECT_NE(new_secret(), new_secret());
  EXPECT_TRUE(is_same_secret("abc", "abc"));
  EXPECT_FALSE(is_same_secret("abc", "abd"));
  EXPECT_FALSE(is_same_secret("abc", "ab"));
}

}  // namespace
}  // namespace lilo::view
