#include "core/standard/cell_map.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace lilo::standard {
namespace {

constexpr float kMinCount = 6.0F;     // points a window needs
constexpr float kFewPoints_m = 0.1F;  // 1 sigma of what one point says of the surface around it
// A direction informs if its spread (1 sigma) stays under this part of the window's width; an even
// filling has 0.29.
constexpr float kThin = 0.065F;
constexpr std::uint32_t kYoung = 4;  // keyframes
constexpr std::size_t kSweepShare = 64;
// Of a tag, from the lowest: x, y, and how high the cell lies.
constexpr int kAcrossBits = 11, kLevelBits = 10;
constexpr std::uint32_t kTagAbove = 1U << (2 * kAcrossBits);
// Of the table: how many cells lie side by side.
constexpr int kBlockBits = 2;
constexpr std::size_t kLevelSlots = 1U << (2 * kBlockBits);

Symmetric outer(const Eigen::Vector3f& v) {
  Symmetric o;
  o << v.x() * v.x(), v.x() * v.y(), v.x() * v.z(), v.y() * v.y(), v.y() * v.z(), v.z() * v.z();
  return o;
}

/// std::floor() is a call where the processor need not have SSE 4.1.
std::int32_t floor_of(double v) {
  constexpr std::uint32_t kAbove = 1U << 30U;  // zero: from there, to cut off is to round down
  return static_cast<std::int32_t>(
      static_cast<std::uint32_t>(static_cast<std::int32_t>(v + kAbove)) - kAbove);
}

}  // namespace

CellMap::CellMap(const CellMapConfig& config)
    : config_(config),
      per_m_(1.0 / static_cast<double>(config.cell_m)),
      kept_(1.0F - 1.0F / config.memory),
      mask_(std::bit_ceil(static_cast<std::size_t>(config.capacity) * 2) - 1),
      slots_(mask_ + 1) {
  const auto capacity = static_cast<std::size_t>(config.capacity);
  cells_.reserve(capacity);
  sums_.reserve(capacity);
  free_.reserve(capacity);
}

CellMap::Index CellMap::index_of(const Eigen::Vector3d& p) const {
  return {floor_of(p.x() * per_m_), floor_of(p.y() * per_m_), floor_of(p.z() * per_m_)};
}

Eigen::Vector3d CellMap::center_of(const Index& i) const {
  return static_cast<double>(config_.cell_m) * Eigen::Vector3d(i.x + 0.5, i.y + 0.5, i.z + 0.5);
}

/// 4 x 4 cells of a level lie side by side, and after them those above: who looks around a cell, or
/// for features beside each other, mostly reads the same few cache lines.
std::size_t CellMap::slot_of(const Index& i) const {
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

std::uint32_t CellMap::tag_of(const Index& i) {
  constexpr std::uint32_t kAcross = (1U << kAcrossBits) - 1U;
  return (static_cast<std::uint32_t>(i.x) & kAcross) |
         (static_cast<std::uint32_t>(i.y) & kAcross) << kAcrossBits |
         static_cast<std::uint32_t>(i.z) << (2 * kAcrossBits);
}

CellMap::Index CellMap::between(std::uint32_t from_tag, std::uint32_t to_tag) {
  const auto part = [&](int low, int bits) {
    const std::uint32_t cut = ((to_tag >> low) - (from_tag >> low)) << (32 - bits);
    return static_cast<std::int32_t>(cut) >> (32 - bits);
  };
  return {part(0, kAcrossBits), part(kAcrossBits, kAcrossBits), part(2 * kAcrossBits, kLevelBits)};
}

CellMap::Place CellMap::place_of(const Eigen::Vector3d& point_m, std::int32_t last) const {
  Place place{index_of(point_m), last};
  if (last != kNone) {
    __builtin_prefetch(&cells_[static_cast<std::size_t>(last)]);
  } else {
    place.slot = slot_of(place.index);
    __builtin_prefetch(&slots_[place.slot]);
  }
  return place;
}

std::int32_t CellMap::cell_at(const Place& place) const {
  std::size_t slot = place.slot;
  if (place.last != kNone) {
    if (cells_[static_cast<std::size_t>(place.last)].index == place.index) return place.last;
    slot = slot_of(place.index);
  }
  const std::int32_t at = slots_[slot_from(slot, tag_of(place.index))].at;
  if (at != kNone) __builtin_prefetch(&cells_[static_cast<std::size_t>(at)]);
  return at;
}

std::size_t CellMap::slot_from(std::size_t slot, std::uint32_t tag) const {
  while (slots_[slot].at != kNone && slots_[slot].tag != tag) slot = (slot + 1) & mask_;
  return slot;
}

std::int32_t CellMap::open(const Place& place) {
  const std::uint32_t tag = tag_of(place.index);
  Slot& slot = slots_[slot_from(place.slot, tag)];
  if (slot.at != kNone) {
    __builtin_prefetch(&sums_[static_cast<std::size_t>(slot.at)], 1);
    return slot.at;
  }
  if (used_ == config_.capacity) {
    ++refused_;
    return kNone;
  }
  auto at = static_cast<std::int32_t>(cells_.size());
  if (free_.empty()) {
    cells_.emplace_back();
    sums_.emplace_back();
  } else {
    at = free_.back();
    free_.pop_back();
    cells_[static_cast<std::size_t>(at)] = Cell{};
    sums_[static_cast<std::size_t>(at)] = Sums{};
  }
  slot = {at, tag};
  ++used_;
  cells_[static_cast<std::size_t>(at)].index = place.index;
  cells_[static_cast<std::size_t>(at)].born = keyframe_;
  return at;
}

void CellMap::add(std::int32_t at, const Place& place, const Eigen::Vector3d& point_m,
                  const Eigen::Vector3f& reach_m) {
  if (at < 0) return;
  Sums& sums = sums_[static_cast<std::size_t>(at)];
  const float kept = sums.count >= config_.memory ? kept_ : 1.0F;
  const Eigen::Vector3f p = (point_m - center_of(place.index)).cast<float>();
  // Seen through a window of three cells, a longer reach is just "all of it".
  const float window2 = 9.0F * config_.cell_m * config_.cell_m;
  const float reach2 = reach_m.squaredNorm();
  const float spread = reach2 > window2 ? window2 / (12.0F * reach2) : 1.0F / 12.0F;  // if even
  sums.count = kept * sums.count + 1.0F;
  sums.point = kept * sums.point + p;
  sums.square = kept * sums.square + (outer(p) + spread * outer(reach_m));
}

Match CellMap::match(std::int32_t at, const Eigen::Vector3d& point_m) {
  if (at < 0) return {};
  Cell& cell = cells_[static_cast<std::size_t>(at)];
  if (keyframe_ >= cell.refit_at) fit(cell);
  if (cell.information.isZero(0.0F)) return {};
  return {(point_m - center_of(cell.index)).cast<float>() - cell.mean_m, &cell.information};
}

std::size_t CellMap::neighbours_of(const Index& i, Neighbours& found) const {
  std::array<std::size_t, Neighbours{}.size()> slots;
  std::array<std::uint32_t, Neighbours{}.size()> tags;
  std::size_t n = 0;
  for (std::int32_t x = -1; x <= 1; ++x) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      const Index lowest{i.x + x, i.y + y, i.z - 1};
      std::size_t slot = slot_of(lowest);
      std::uint32_t tag = tag_of(lowest);
      for (int level = 0; level < 3; ++level, ++n) {
        slots[n] = slot;
        tags[n] = tag;
        __builtin_prefetch(&slots_[slot]);
        slot = (slot + kLevelSlots) & mask_;
        tag += kTagAbove;
      }
    }
  }
  const auto cells_m = [&](std::size_t cells) {
    return config_.cell_m * (static_cast<float>(cells) - 1.0F);
  };
  std::size_t count = 0;
  for (n = 0; n < slots.size(); ++n) {
    const std::int32_t at = slots_[slot_from(slots[n], tags[n])].at;
    if (at == kNone) continue;
    __builtin_prefetch(&sums_[static_cast<std::size_t>(at)]);
    found[count++] = {at, cells_m(n / 9), cells_m(n / 3 % 3), cells_m(n % 3)};
  }
  return count;
}

CellMap::Sums CellMap::sums_around(const Index& i) const {
  Neighbours neighbours;
  const std::size_t n = neighbours_of(i, neighbours);
  float count = 0.0F;
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  Symmetric square = Symmetric::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const Neighbour& o = neighbours[k];
    const Sums& one = sums_[static_cast<std::size_t>(o.at)];
    const Eigen::Vector3f& p = one.point;
    const Eigen::Vector3f q = p + one.count * Eigen::Vector3f(o.x_m, o.y_m, o.z_m);
    count += one.count;
    point += q;
    // o p' + p o' + count o o'
    square[0] += one.square[0] + o.x_m * (p.x() + q.x());
    square[1] += one.square[1] + (o.x_m * q.y() + o.y_m * p.x());
    square[2] += one.square[2] + (o.x_m * q.z() + o.z_m * p.x());
    square[3] += one.square[3] + o.y_m * (p.y() + q.y());
    square[4] += one.square[4] + (o.y_m * q.z() + o.z_m * p.y());
    square[5] += one.square[5] + o.z_m * (p.z() + q.z());
  }
  return {count, point, square};
}

void CellMap::fit(Cell& cell) const {
  const std::uint32_t age = keyframe_ - cell.born;
  cell.refit_at = keyframe_ + (age < kYoung ? 1 : std::max(6U, age / 2));
  cell.information.setZero();
  const Sums sums = sums_around(cell.index);
  if (sums.count < kMinCount) return;
  cell.mean_m = sums.point / sums.count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(matrix_of<float>(sums.square / sums.count - outer(cell.mean_m)));
  const float thin_m = kThin * 3.0F * config_.cell_m;
  const float doubt = config_.noise_m * config_.noise_m + kFewPoints_m * kFewPoints_m / sums.count;
  // Thin in two directions, a strip of ground may lean any way about its length.
  constexpr float kUpright = 0.7F;  // cosine
  if (config_.level && (solver.eigenvalues()[1] < thin_m * thin_m ||
                        std::abs(solver.eigenvectors()(2, 0)) < kUpright)) {
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const float variance = std::max(solver.eigenvalues()[k], 0.0F) + doubt;
    const float weight = std::max(0.0F, 1.0F / variance - 1.0F / (thin_m * thin_m));
    cell.information += weight * outer(solver.eigenvectors().col(k));
  }
}

void CellMap::append_means(std::vector<Eigen::Vector3f>& points_m) const {
  for (const Slot& slot : slots_) {
    if (slot.at < 0) continue;
    const Sums& sums = sums_[static_cast<std::size_t>(slot.at)];
    const Eigen::Vector3d center = center_of(cells_[static_cast<std::size_t>(slot.at)].index);
    points_m.emplace_back(center.cast<float>() + sums.point / sums.count);
  }
}

void CellMap::clear() {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  cells_.clear();
  sums_.clear();
  free_.clear();
  used_ = 0;
}

void CellMap::remove(std::size_t slot) {
  free_.push_back(slots_[slot].at);
  --used_;
  // Backward shift: later entries of the probe chain move into the hole, no tombstones.
  std::size_t hole = slot;
  for (std::size_t next = (hole + 1) & mask_; slots_[next].at >= 0; next = (next + 1) & mask_) {
    const std::size_t home = slot_of(cells_[static_cast<std::size_t>(slots_[next].at)].index);
    if (((next - home) & mask_) < ((next - hole) & mask_)) continue;
    slots_[hole] = slots_[next];
    hole = next;
  }
  slots_[hole] = Slot{};
}

void CellMap::forget_beyond(const Eigen::Vector3d& center_m, double radius_m) {
  const std::size_t share = (mask_ + 1) / kSweepShare;
  const Index center = index_of(center_m);
  const std::uint32_t center_tag = tag_of(center);
  const Eigen::Vector3d rest_m = center_of(center) - center_m;
  const auto cell_m = static_cast<double>(config_.cell_m);
  for (std::size_t n = 0; n < share; ++n) {
    // The tag tells where a cell is: to read each of them would take most of the time.
    if (slots_[sweep_].at >= 0) {
      const Index from = between(center_tag, slots_[sweep_].tag);
      const Eigen::Vector3d from_m = cell_m * Eigen::Vector3d(from.x, from.y, from.z) + rest_m;
      if (from_m.squaredNorm() > radius_m * radius_m) {
        remove(sweep_);
        continue;  // another cell may have moved into this slot
      }
    }
    sweep_ = (sweep_ + 1) & mask_;
  }
}

}  // namespace lilo::standard
