// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/stream_log.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lilo::view {
namespace {

std::vector<std::string> all_after(const StreamLog& log, std::uint64_t id) {
  std::vector<std::string> lines;
  log.for_each_after(id, [&](const StreamLog::Line& line) { lines.push_back(line.text); });
  return lines;
}

TEST(StreamLog, IsReadOnFromAnywhere) {
  StreamLog log(1U << 20U);
  for (int k = 0; k < 10; ++k) log.add(LineKind::pose, "line " + std::to_string(k));
  EXPECT_EQ(log.last_id(), 10U);
  std::string text;
  std::uint64_t at = 0;
  std::string whole;
  for (int reads = 0; reads < 100; ++reads) {
    at = log.read_after(at, 15, text);  // two lines and a bit
    if (text.empty()) break;
    EXPECT_LE(text.size(), 21U);
    whole += text;
  }
  EXPECT_EQ(at, 10U);
  EXPECT_EQ(whole,
            "line 0\nline 1\nline 2\nline 3\nline 4\nline 5\nline 6\nline 7\nline 8\nline 9\n");
  EXPECT_EQ(all_after(log, 8), (std::vector<std::string>{"line 8", "line 9"}));
  EXPECT_TRUE(all_after(log, 10).empty());
}

// However much is added, memory is bounded; poses stay where points can go.
TEST(StreamLog, ThinsPointsFirst) {
  constexpr std::size_t kBytes = 200'000;
  StreamLog log(kBytes);
  for (int k = 0; k < 100; ++k) {
    log.add(LineKind::pose, "pose " + std::to_string(k));
    for (int n = 0; n < 10; ++n) log.add(LineKind::points, std::string(1000, 'x'));
    EXPECT_LE(log.bytes(), kBytes);
  }
  EXPECT_GT(log.thinnings(), 0);
  int poses = 0, points = 0;
  log.for_each_after(
      0, [&](const StreamLog::Line& line) { (line.kind == LineKind::pose ? poses : points) += 1; });
  EXPECT_EQ(poses, 100);
  EXPECT_GT(points, 50);
}

TEST(StreamLog, IsBoundedWithoutAnyPoints) {
  constexpr std::size_t kBytes = 100'000;
  StreamLog log(kBytes);
  for (int k = 0; k < 20'000; ++k) {
    log.add(LineKind::pose, "pose " + std::to_string(k));
    ASSERT_LE(log.bytes(), kBytes);
  }
  const std::vector<std::string> left = all_after(log, 0);
  EXPECT_EQ(left.back(), "pose 19999");
  EXPECT_EQ(left.front(), "pose 0") << "the first of two stays";
}

}  // namespace
}  // namespace lilo::view
