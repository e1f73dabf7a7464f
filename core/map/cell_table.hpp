// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

/// A hash table from the index of a cell to its number.
namespace lilo::core {

/// A cubic cell of space, counted from the origin.
struct CellIndex {
  std::int32_t x, y, z;
  bool operator==(const CellIndex&) const = default;
};

/// Open addressing, linear probing, no tombstones. A slot holds a tag of its cell: the low bits of
/// the index, which differ between all cells of a window of 2048 x 2048 x 1024. So find() need not
/// read the cells. Memory is reserved at construction. Not thread-safe.
class CellTable {
 public:
  static constexpr std::int32_t kNone = -1;
  /// Height of the window, its smallest side. Tags wrap around: a cell more than half of the height
  /// above the middle seems to lie below it, at a distance of the height less its own. A map that
  /// forgets cells beyond a radius forgets it all the same, if its distance and the radius together
  /// are less than kSafeLevels. The two cells in between are for rounding.
  static constexpr std::int32_t kLevels = 1024;
  static constexpr std::int32_t kSafeLevels = kLevels - 2;

  struct Slot {
    std::int32_t at = kNone;  ///< the cell's number; kNone: empty
    std::uint32_t tag = 0;
  };

  /// At least half of the slots stay empty.
  explicit CellTable(std::size_t capacity)
      : mask_(std::bit_ceil(2 * capacity) - 1), slots_(mask_ + 1) {}

  /// Where the search for a cell begins. 4 x 4 cells of a level lie side by side, and those above
  /// come next. So a search around a cell, or for features beside each other, mostly reads the same
  /// few cache lines.
  [[nodiscard]] std::size_t bucket_of(const CellIndex& i) const {
    constexpr std::int32_t kInside = (1 << kBlockBits) - 1;
    const auto block = [](std::int32_t v) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v >> kBlockBits));
    };
    std::uint64_t h = block(i.x) * 0x9E3779B97F4A7C15ULL ^ block(i.y) * 0xC2B2AE3D27D4EB4FULL;
    h ^= h >> 29U;
    h = h * 0xBF58476D1CE4E5B9ULL >> 20U;
    const auto inside = static_cast<std::uint32_t>((i.y & kInside) << kBlockBits | (i.x & kInside));
    return static_cast<std::size_t>((h + static_cast<std::uint32_t>(i.z)) * kLevelSlots + inside) &
           mask_;
  }
  [[nodiscard]] static std::uint32_t tag_of(const CellIndex& i) {
    constexpr std::uint32_t kAcross = (1U << kAcrossBits) - 1U;
    return (static_cast<std::uint32_t>(i.x) & kAcross) |
           (static_cast<std::uint32_t>(i.y) & kAcross) << kAcrossBits |
           static_cast<std::uint32_t>(i.z) << (2 * kAcrossBits);
  }
  /// Both, of the cell above.
  [[nodiscard]] std::size_t bucket_above(std::size_t bucket) const {
    return (bucket + kLevelSlots) & mask_;
  }
  [[nodiscard]] static std::uint32_t tag_above(std::uint32_t tag) {
    return tag + (1U << (2 * kAcrossBits));
  }
  /// From one cell to another, the short way round the tags' window.
  [[nodiscard]] static CellIndex between(std::uint32_t from_tag, std::uint32_t to_tag) {
    const auto part = [&](int low, int bits) {
      const std::uint32_t cut = ((to_tag >> low) - (from_tag >> low)) << (32 - bits);
      return static_cast<std::int32_t>(cut) >> (32 - bits);
    };
    return {part(0, kAcrossBits), part(kAcrossBits, kAcrossBits),
            part(2 * kAcrossBits, kLevelBits)};
  }

  /// Asks the memory for what find() will read.
  void prefetch(std::size_t bucket) const { __builtin_prefetch(&slots_[bucket]); }
  /// The cell's number, or kNone.
  [[nodiscard]] std::int32_t find(std::size_t bucket, std::uint32_t tag) const {
    return slots_[slot_from(bucket, tag)].at;
  }
  /// Of a cell that is not there.
  void insert(std::size_t bucket, std::uint32_t tag, std::int32_t at) {
    slots_[slot_from(bucket, tag)] = {at, tag};
  }
  /// Empties a slot. Others may move into it: `bucket_of_cell(at)` tells where a cell's search
  /// begins.
  template <typename BucketOfCell>
  void remove(std::size_t slot, const BucketOfCell& bucket_of_cell) {
    std::size_t hole = slot;
    for (std::size_t next = (hole + 1) & mask_; slots_[next].at != kNone;
         next = (next + 1) & mask_) {
      const std::size_t bucket = bucket_of_cell(slots_[next].at);
      if (((next - bucket) & mask_) < ((next - hole) & mask_)) continue;
      slots_[hole] = slots_[next];
      hole = next;
    }
    slots_[hole] = Slot{};
  }
  /// Empties the slots from there to the next empty one. Called with the bucket of every cell, in
  /// any order, it empties the table: a cell that an earlier call left is before the bucket of that
  /// call, and so is its own bucket. With few cells that is far less than the whole table.
  void clear_from(std::size_t bucket) {
    for (; slots_[bucket].at != kNone; bucket = after(bucket)) slots_[bucket] = Slot{};
  }

  [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
  [[nodiscard]] std::size_t after(std::size_t slot) const { return (slot + 1) & mask_; }

 private:
  // Bits of a tag, from the lowest: x, y and z.
  static constexpr int kAcrossBits = 11, kLevelBits = 10;
  static_assert(kLevels == 1 << kLevelBits && kLevelBits < kAcrossBits);
  // 1 << kBlockBits cells in x and in y lie side by side.
  static constexpr int kBlockBits = 2;
  static constexpr std::size_t kLevelSlots = 1U << (2 * kBlockBits);

  /// The slot that holds it, or else the first empty one.
  [[nodiscard]] std::size_t slot_from(std::size_t bucket, std::uint32_t tag) const {
    while (slots_[bucket].at != kNone && slots_[bucket].tag != tag) bucket = (bucket + 1) & mask_;
    return bucket;
  }

  std::size_t mask_;
  std::vector<Slot> slots_;
};

}  // namespace lilo::core
