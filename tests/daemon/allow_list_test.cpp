// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/allow_list.hpp"

#include "config/text_forms.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lilo {
namespace {

bool allows(const char* range, const char* address) {
  return AllowList({range}).contains(boost::asio::ip::make_address(address));
}

TEST(AllowList, AddressesAndRangesOfBothFamilies) {
  EXPECT_TRUE(allows("10.0.0.7", "10.0.0.7"));
  EXPECT_FALSE(allows("10.0.0.7", "10.0.0.8"));
  EXPECT_TRUE(allows("192.168.1.0/24", "192.168.1.255"));
  EXPECT_FALSE(allows("192.168.1.0/24", "192.168.2.0"));
  EXPECT_TRUE(allows("10.1.2.3/9", "10.127.0.1")) << "bits beyond the prefix do not count";
  EXPECT_FALSE(allows("10.1.2.3/9", "10.128.0.1"));
  EXPECT_TRUE(allows("0.0.0.0/0", "203.0.113.9"));
  EXPECT_TRUE(allows("2001:db8::5", "2001:db8:0::5"));
  EXPECT_FALSE(allows("2001:db8::5", "2001:db8::6"));
  EXPECT_TRUE(allows("fd00::/8", "fdff::1"));
  EXPECT_FALSE(allows("fd00::/8", "fe80::1"));
  EXPECT_FALSE(AllowList({}).contains(boost::asio::ip::make_address("10.0.0.7")));
}

TEST(AllowList, IPv4InIPv6IsIPv4) {
  EXPECT_TRUE(allows("10.0.0.0/8", "::ffff:10.9.8.7"));
  EXPECT_TRUE(allows("::ffff:10.9.8.7", "10.9.8.7"));
  EXPECT_FALSE(allows("::/0", "10.9.8.7")) << "a range of one family is not of the other";
  EXPECT_FALSE(allows("0.0.0.0/0", "fd00::1"));
}

// What the configuration takes, the list takes, and nothing else.
TEST(AllowList, AgreesWithTheConfiguration) {
  for (const char* good : {"10.0.0.7", "10.0.0.0/8", "0.0.0.0/0", "10.0.0.1/32", "::/0", "fd00::1",
                           "fe80::/10", "2001:db8::/128"}) {
    EXPECT_TRUE(is_address_range(good)) << good;
    EXPECT_NO_THROW(AllowList({good})) << good;
  }
  for (const char* bad : {"", "10.0.0", "10.0.0.0/33", "10.0.0.0/-1", "10.0.0.0/", "10.0.0.0/8 ",
                          "fd00::/129", "host", "10.0.0.0/8/8", "/8"}) {
    EXPECT_FALSE(is_address_range(bad)) << bad;
    EXPECT_THROW(AllowList({bad}), std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace lilo
