// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <random>
#include <thread>

namespace lilo {
namespace {

bool push(SpscRing<int>& ring, int value) {
  int* slot = ring.reserve();
  if (slot == nullptr) return false;
  *slot = value;
  ring.commit();
  return true;
}

bool pop(SpscRing<int>& ring, int& value) {
  const int* slot = ring.front();
  if (slot == nullptr) return false;
  value = *slot;
  ring.release();
  return true;
}

TEST(SpscRing, BehavesAsABoundedQueue) {
  std::mt19937 random(7);
  for (std::size_t capacity = 1; capacity <= 9; ++capacity) {
    SpscRing<int> ring(capacity);
    std::deque<int> model;
    for (int step = 0; step < 5000; ++step) {
      if (random() % 2 == 0) {
        const bool fits = model.size() < capacity;
        ASSERT_EQ(push(ring, step), fits);
        if (fits) model.push_back(step);
      } else {
        int value = -1;
        ASSERT_EQ(pop(ring, value), !model.empty());
        if (!model.empty()) {
          ASSERT_EQ(value, model.front());
          model.pop_front();
        }
      }
      ASSERT_EQ(ring.size(), model.size());
    }
  }
}

// As a worker does that skips what it is too late for: the next look must not go beyond the end.
TEST(SpscRing, SlotsMayBeReleasedUnseen) {
  SpscRing<int> ring(4);
  ASSERT_TRUE(push(ring, 0));
  ASSERT_NE(ring.front(), nullptr);
  for (int value = 1; value < 4; ++value) ASSERT_TRUE(push(ring, value));
  while (ring.size() > 1) ring.release();
  int value = -1;
  ASSERT_TRUE(pop(ring, value));
  EXPECT_EQ(value, 3);
  EXPECT_EQ(ring.front(), nullptr);
  ASSERT_TRUE(push(ring, 4));
  ASSERT_TRUE(pop(ring, value));
  EXPECT_EQ(value, 4);
  EXPECT_EQ(ring.size(), 0U);
}

TEST(SpscRing, FillsAndEmptiesFromEveryIndex) {
  constexpr std::size_t kCapacity = 5;
  for (std::size_t shift = 0; shift < 2 * kCapacity; ++shift) {
    SpscRing<int> ring(kCapacity);
    int value = 0;
    for (std::size_t i = 0; i < shift; ++i) {
      ASSERT_TRUE(push(ring, 0));
      ASSERT_TRUE(pop(ring, value));
    }
    for (int i = 0; i < static_cast<int>(kCapacity); ++i) ASSERT_TRUE(push(ring, i));
    EXPECT_EQ(ring.reserve(), nullptr);
    for (int i = 0; i < static_cast<int>(kCapacity); ++i) {
      ASSERT_TRUE(pop(ring, value));
      EXPECT_EQ(value, i);
    }
    EXPECT_EQ(ring.front(), nullptr);
  }
}

TEST(SpscRing, GivesTheSameSlotUntilItIsHandedOn) {
  SpscRing<int> ring(2);
  int* slot = ring.reserve();
  EXPECT_EQ(ring.reserve(), slot);
  EXPECT_EQ(ring.front(), nullptr);
  ring.commit();
  EXPECT_NE(ring.reserve(), slot);
  EXPECT_EQ(ring.front(), slot);
  EXPECT_EQ(ring.front(), slot);
}

TEST(SpscRing, SlotsKeepTheirMemory) {
  SpscRing<std::vector<int>> ring(2);
  ring.for_each_slot([](std::vector<int>& slot) { slot.reserve(1000); });
  for (int i = 0; i < 7; ++i) {
    std::vector<int>* slot = ring.reserve();
    ASSERT_NE(slot, nullptr);
    EXPECT_GE(slot->capacity(), 1000U);
    slot->assign(10, i);
    ring.commit();
    EXPECT_EQ(ring.front()->at(9), i);
    ring.release();
  }
}

// Run under the tsan preset this also shows that no slot is touched by both threads at once.
TEST(SpscRing, TwoThreadsPassEverySlotOnceInOrder) {
  struct Slot {
    std::uint64_t number = 0, twice = 0;
  };
  for (const std::size_t capacity : {std::size_t{1}, std::size_t{3}, std::size_t{64}}) {
    // A thread that must wait after each slot or two waits for all that a busy machine runs.
    const std::uint64_t count = 3'000 * capacity;
    SpscRing<Slot> ring(capacity);
    std::thread producer([&] {
      for (std::uint64_t i = 0; i < count;) {
        Slot* slot = ring.reserve();
        if (slot == nullptr) {
          std::this_thread::yield();
          continue;
        }
        *slot = {i, 2 * i};
        ring.commit();
        ++i;
      }
    });
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i < count;) {
      const Slot* slot = ring.front();
      if (slot == nullptr) {
        std::this_thread::yield();
        continue;
      }
      wrong += slot->number != i || slot->twice != 2 * i ? 1U : 0U;
      ring.release();
      ++i;
    }
    producer.join();
    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(ring.size(), 0U);
  }
}

}  // namespace
}  // namespace lilo
