// SPDX-License-Identifier: BSD-3-Clause
// Gaps of several turns, after which a scan may begin in the middle of one.
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace lilo {
namespace {

using test::build;
using test::Outcome;
using test::Room;
using test::TimedPacket;
using test::vlp16_packets;

void drop(std::vector<TimedPacket>& packets, int first, int count) {
  packets.erase(packets.begin() + first, packets.begin() + first + count);
}

TEST(Assembly, TheFragmentAfterALongGapIsLeftOut) {
  auto packets = vlp16_packets(840, {});
  std::swap(packets[625], packets[626]);
  drop(packets, 630, 1);
  drop(packets, 100, 520);  // 0.69 s; the first cut after it is that of turn 9
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.packets_lost, 521U);
  EXPECT_EQ(out.counts.packets_late, 0U);
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_FALSE(out.scans[1].complete);
  EXPECT_NEAR(out.scans[1].packets.lost, 54.5, 1.0) << "of its own turn alone";
  EXPECT_EQ(out.scans[2].index, 9U);
  EXPECT_TRUE(out.scans[2].complete);
  EXPECT_EQ(out.scans[2].packets.lost, 0U);
  for (const Return& r : out.scans[2].returns) ASSERT_LT(Room::distance_to_surface_m(r), 0.002);
}

TEST(Assembly, TheFragmentAfterAShortGapIsAScan) {
  auto packets = vlp16_packets(520, {});
  drop(packets, 100, 350);  // 0.46 s
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 3U);
  EXPECT_EQ(out.scans[2].index, 5U);
  EXPECT_FALSE(out.scans[2].complete);
}

}  // namespace
}  // namespace lilo
