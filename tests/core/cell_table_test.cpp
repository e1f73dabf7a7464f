// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/cell_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>
#include <vector>

namespace lilo::core {
namespace {

// As full as a table may be, and its cells crowd around the origin, on both sides of it: searches
// run into each other, and past the end of the table.
TEST(CellTable, KnowsWhatAnOrderedMapKnows) {
  constexpr int kCapacity = 256;
  CellTable table(kCapacity);
  std::map<std::tuple<int, int, int>, std::int32_t> truth;
  std::vector<CellIndex> cells;  // by number
  std::mt19937 rng(7);
  std::uniform_int_distribution<int> across(-6, 5), level(-2, 1);
  const auto bucket_of = [&](std::int32_t at) {
    return table.bucket_of(cells[static_cast<std::size_t>(at)]);
  };
  for (int turn = 0; turn < 20000; ++turn) {
    const CellIndex i{across(rng), across(rng), level(rng)};
    const std::size_t home = table.bucket_of(i);
    const std::uint32_t tag = CellTable::tag_of(i);
    const auto known = truth.find({i.x, i.y, i.z});
    if (known == truth.end()) {
      ASSERT_EQ(table.find(home, tag), CellTable::kNone);
      if (truth.size() == kCapacity) continue;
      const auto at = static_cast<std::int32_t>(cells.size());
      cells.push_back(i);
      table.insert(home, tag, at);
      truth[{i.x, i.y, i.z}] = at;
      continue;
    }
    ASSERT_EQ(table.find(home, tag), known->second);
    if (turn % 3 == 0) continue;
    const auto& slots = table.slots();
    const auto slot = std::find_if(slots.begin(), slots.end(),
                                   [&](const CellTable::Slot& s) { return s.at == known->second; });
    ASSERT_NE(slot, slots.end());
    table.remove(static_cast<std::size_t>(slot - slots.begin()), bucket_of);
    truth.erase(known);
  }
  EXPECT_GT(truth.size(), 100U);
  for (const auto& [index, at] : truth) {
    const auto [x, y, z] = index;
    EXPECT_EQ(table.find(table.bucket_of({x, y, z}), CellTable::tag_of({x, y, z})), at);
  }
  for (const auto& [index, at] : truth) table.clear_from(bucket_of(at));
  EXPECT_TRUE(std::all_of(table.slots().begin(), table.slots().end(),
                          [](const CellTable::Slot& s) { return s.at == CellTable::kNone; }));
}

TEST(CellTable, ATagTellsTheWayFromCellToCell) {
  std::mt19937 rng(8);
  std::uniform_int_distribution<int> place(-100000, 100000), across(-1024, 1023), up(-512, 511);
  for (int k = 0; k < 1000; ++k) {
    const CellIndex from{place(rng), place(rng), place(rng)};
    const CellIndex way{across(rng), across(rng), up(rng)};
    const CellIndex to{from.x + way.x, from.y + way.y, from.z + way.z};
    EXPECT_EQ(CellTable::between(CellTable::tag_of(from), CellTable::tag_of(to)), way);
  }
}

TEST(CellTable, KnowsTheCellAbove) {
  const CellTable table(100);
  for (const CellIndex i : {CellIndex{3, -5, 7}, CellIndex{-1, -1, -1}, CellIndex{0, 0, 511}}) {
    const CellIndex above{i.x, i.y, i.z + 1};
    EXPECT_EQ(table.bucket_above(table.bucket_of(i)), table.bucket_of(above));
    EXPECT_EQ(CellTable::tag_above(CellTable::tag_of(i)), CellTable::tag_of(above));
  }
}

}  // namespace
}  // namespace lilo::core
