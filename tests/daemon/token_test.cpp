// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/token.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace lilo {
namespace {

// The vectors of SipHash's own reference program: key 00 01 .. 0f, message 00 01 .. of each length.
TEST(SipHash, ReferenceVectors) {
  const SipKey key{0x0706050403020100, 0x0f0e0d0c0b0a0908};
  std::vector<std::byte> message;
  const auto next = [&] { message.push_back(static_cast<std::byte>(message.size())); };
  EXPECT_EQ(siphash(key, message), 0x726fdb47dd0e0e31U);
  next();
  EXPECT_EQ(siphash(key, message), 0x74f839c593dc67fdU);
  while (message.size() < 8) next();
  EXPECT_EQ(siphash(key, message), 0x93f5f5799a932462U);
  while (message.size() < 15) next();
  EXPECT_EQ(siphash(key, message), 0xa129ca6149be45e5U) << "the example of the paper, appendix A";
}

TEST(TokenMaker, BelongsToOneAddressForAMinute) {
  const TokenMaker maker, other;
  constexpr std::int64_t kSecond = 1'000'000'000, now = 1'000 * kSecond;
  const Requester who{.address = {10, 0, 0, 1}, .port = 4711};
  const Requester other_port{.address = {10, 0, 0, 1}, .port = 4712};
  const Requester other_address{.address = {10, 0, 0, 2}, .port = 4711};
  const std::string token = maker.make(who, now);
  EXPECT_TRUE(maker.accept(token, who, now));
  EXPECT_TRUE(maker.accept(token, who, now + 30 * kSecond));
  EXPECT_FALSE(maker.accept(token, who, now + 60 * kSecond));
  EXPECT_FALSE(maker.accept(token, other_port, now));
  EXPECT_FALSE(maker.accept(token, other_address, now));
  EXPECT_FALSE(maker.accept("", who, now));
  EXPECT_FALSE(other.accept(token, who, now)) << "keys are random";
}

}  // namespace
}  // namespace lilo
