// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/sensitivity.hpp"
#include "core/constants.hpp"
#include "core/map/cell_table.hpp"
#include "core/map/moments.hpp"
#include "core/odometry_config.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// A map: points summed up in small cubic cells of a hash table.
namespace lilo::core {

/// What the map tells of a point.
struct Match {
  Eigen::Vector3f from_mean_m;             ///< from the mean of the map points around it
  const Symmetric* information = nullptr;  ///< 1/m^2; nullptr: the map tells nothing there
  /// Whether there are enough points, seen from this side. If they tell nothing, they are thick or
  /// a strip of ground.
  bool is_known = false;
};

struct CellMapConfig {
  float cell_m = static_cast<float>(DefaultConfig{}.cell_m);
  /// 1 sigma of a return across a surface.
  float noise_m = static_cast<float>(DefaultConfig{}.noise_m);
  /// A map of ground. It gives information of height and slope only, and none where only a strip of
  /// ground was seen. The end of a strip, at a wall or at one ring, moves with the sensor and would
  /// hold the sensor in place; the foot of the wall would make it a slope.
  bool level = false;
  /// Whether the sensitivities of the points are averaged as well; of ground only the height's.
  bool with_sensitivity = false;
  /// The most cells. Points that need another one are left out and counted.
  int capacity = DefaultConfig{}.map_cells;
};

/// The distribution of a cell is the Gaussian of the points in the 3x3x3 cells around it, its
/// window. It gives information only along directions in which the points are thin against the
/// window: a wall along its normal, a trunk across its axis, foliage hardly at all. Points that
/// fill the window evenly would only hold the scan in place, and drag it towards what was seen
/// first.
///
/// A surface is matched only from the side from which it was seen. The two faces of a thin wall lie
/// in one cell, and a sensor that comes through the door sees the other one. On stairs it sees
/// first the lower face of a landing, then the upper one.
///
/// Memory is reserved at construction. Not thread-safe.
class CellMap {
 public:
  static constexpr std::int32_t kNone = CellTable::kNone;
  /// A cell's key in the table, whether it is there or not.
  struct CellKey {
    CellIndex index{};
    std::int32_t cached = kNone;  ///< the cell that it was before, if a point has hardly moved
    std::size_t bucket = 0;       ///< in the table; only where nothing is cached
  };
  /// Vector to the next sample of the same surface (Feature::dx_m). The surface between the two was
  /// not seen and counts as spread evenly. Otherwise a single ring on the ground looks like a plane
  /// that contains its own rays, and such a plane does not see pitch ("cone lock").
  struct SampleGap {
    explicit SampleGap(const Eigen::Vector3f& gap_m)
        : square_m2(gap_m.squaredNorm()), outer_m2(outer(gap_m)) {}
    float square_m2;
    Symmetric outer_m2;
  };

  explicit CellMap(const CellMapConfig& config);

  /// Adds a point of the odometry frame. `ray`: unit vector from the sensor to it; zero: not known.
  void insert(const Eigen::Vector3d& point_m, const Eigen::Vector3f& gap_m,
              const Eigen::Vector3f& ray = Eigen::Vector3f::Zero()) {
    const CellKey key = key_of(point_m);
    add(find_or_insert(key), key, point_m, SampleGap(gap_m), ray);
  }

  /// The distribution around a point that is seen along `ray` (of any length; zero: not known).
  /// Fits are cached: a cell is fitted again when its age in keyframes has grown by half.
  Match find(const Eigen::Vector3d& point_m, const Eigen::Vector3f& ray = Eigen::Vector3f::Zero()) {
    return match(cell_at(key_of(point_m)), point_m, ray);
  }

  /// find() and insert() in steps. Each step but the last prefetches what the next one reads: taken
  /// for many points at a time, no step waits for the memory.
  /// `cached`: the result of cell_at() for this point in the same map before.
  [[nodiscard]] CellKey key_of(const Eigen::Vector3d& point_m, std::int32_t cached = kNone) const {
    CellKey key{index_of(point_m), cached};
    if (cached != kNone) {
      __builtin_prefetch(&cells_[static_cast<std::size_t>(cached)]);
    } else {
      key.bucket = table_.bucket_of(key.index);
      table_.prefetch(key.bucket);
    }
    return key;
  }
  [[nodiscard]] std::int32_t cell_at(const CellKey& key) const {
    std::size_t bucket = key.bucket;
    if (key.cached != kNone) {
      if (cells_[static_cast<std::size_t>(key.cached)].index == key.index) return key.cached;
      bucket = table_.bucket_of(key.index);
    }
    const std::int32_t at = table_.find(bucket, CellTable::tag_of(key.index));
    if (at != kNone) __builtin_prefetch(&cells_[static_cast<std::size_t>(at)]);
    return at;
  }
  Match match(std::int32_t at, const Eigen::Vector3d& point_m, const Eigen::Vector3f& ray) {
    if (at == kNone) return {};
    Cell& cell = cells_[static_cast<std::size_t>(at)];
    if (keyframe_ >= cell.refit_at) fit(cell);
    if (cell.information.isZero(0.0F)) return {.is_known = cell.is_known};
    if (is_behind(cell, ray)) return {};
    return {.from_mean_m = (point_m - center_of(cell.index)).cast<float>() - cell.mean_m,
            .information = &cell.information,
            .is_known = true};
  }
  /// Subtracts the rigid motion from the sensitivity of every point.
  void subtract_sensitivity(const PoseSensitivity& rigid);
  /// Of the points that match() answers with, all those around: mean sensitivity, zero where it is
  /// not kept, and mean.
  struct MeanSensitivity {
    Sensitivity sensitivity = Sensitivity::Zero();
    Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] MeanSensitivity sensitivity_around(std::int32_t at) const;
  /// The cell there, made if missing; kNone where there is no room.
  std::int32_t find_or_insert(const CellKey& key) {
    const std::int32_t at = table_.find(key.bucket, CellTable::tag_of(key.index));
    if (at == kNone) return make(key);
    prefetch_sums(at);
    const auto cell = static_cast<std::size_t>(at);
    __builtin_prefetch(&rays_[cell]);
    if (config_.with_sensitivity) __builtin_prefetch(&sensitivity_rows_[row_of(cell, 2)]);
    return at;
  }
  void add(std::int32_t at, const CellKey& key, const Eigen::Vector3d& point_m,
           const SampleGap& gap, const Eigen::Vector3f& ray,
           const Sensitivity& sensitivity = Sensitivity::Zero()) {
    if (at == kNone) return;
    Moments& sums = sums_[static_cast<std::size_t>(at)];
    // A gap longer than the window of three cells fills all of it.
    const float window_m2 = 9.0F * config_.cell_m * config_.cell_m;
    const float spread =
        gap.square_m2 > window_m2 ? window_m2 / (12.0F * gap.square_m2) : 1.0F / 12.0F;  // if even
    const Eigen::Vector3f p = (point_m - center_of(key.index)).cast<float>();
    const float kept = count_of(sums) >= map::kMemory ? kKept : 1.0F;
    add_to(sums, kept, moments_of(p, spread, gap.outer_m2));
    Eigen::Vector3f& rays = rays_[static_cast<std::size_t>(at)];
    rays = kept * rays + ray;
    if (!config_.with_sensitivity) return;
    for (int row = first_row(); row < 3; ++row) {
      SensitivityRow& sum = sensitivity_rows_[row_of(static_cast<std::size_t>(at), row)];
      sum = kept * sum + sensitivity.row(row);
    }
  }

  void end_keyframe() { ++keyframe_; }

  /// Forgets everything, keeps the memory.
  void clear();

  /// Forgets cells farther than `radius_m` from `center_m`, and nearer ones where the map is nearly
  /// full (map::kNearlyFull), so that there is room for what comes into view. Every call looks at
  /// the next small part of the table, so that no single scan pays for the whole.
  void forget_beyond(const Eigen::Vector3d& center_m, double radius_m);

  /// Calls `visit` with the mean of every cell's own points (m), in no particular order.
  template <typename Visit>
  void for_each_mean(const Visit& visit) const {
    for (const CellTable::Slot& slot : table_.slots()) {
      if (slot.at == kNone) continue;
      const auto at = static_cast<std::size_t>(slot.at);
      visit(center_of(cells_[at].index) + own_mean_of(at).cast<double>());
    }
  }

  [[nodiscard]] int size() const { return used_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  /// Part of a full cell's sums that one more point leaves.
  static constexpr float kKept = 1.0F - 1.0F / map::kMemory;
  /// What find() reads: one cache line.
  struct alignas(64) Cell {
    CellIndex index{};
    std::uint32_t born = 0;                            // keyframe
    std::uint32_t refit_at = 0;                        // keyframe from which the fit is out of date
    Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();  // from the cell's centre
    Symmetric information = Symmetric::Zero();         // zero: it tells nothing
    std::array<std::int16_t, 3> inwards{};  // into the surface, of any length; zero: not known
    bool is_known = false;                  // there are enough points
  };
  static_assert(sizeof(Cell) == 64);
  struct Neighbour {
    std::int32_t at;
    float x_m, y_m, z_m;  // from the one in the middle
  };
  using Neighbours = std::array<Neighbour, 27>;

  [[nodiscard]] CellIndex index_of(const Eigen::Vector3d& p) const {
    return {floor_of(p.x() * per_m_), floor_of(p.y() * per_m_), floor_of(p.z() * per_m_)};
  }
  [[nodiscard]] Eigen::Vector3d center_of(const CellIndex& i) const {
    return static_cast<double>(config_.cell_m) * Eigen::Vector3d(i.x + 0.5, i.y + 0.5, i.z + 0.5);
  }
  /// std::floor() is a call where the processor need not have SSE 4.1. Values beyond a billion
  /// cells are cut off there, and so is nan.
  static std::int32_t floor_of(double v) {
    constexpr std::uint32_t kAbove = 1U << 30U;  // added first: to cut off is then to round down
    constexpr double kFar = kAbove - 2U;
    v = v > -kFar ? v : -kFar;
    v = v < kFar ? v : kFar;
    return static_cast<std::int32_t>(
        static_cast<std::uint32_t>(static_cast<std::int32_t>(v + kAbove)) - kAbove);
  }
  /// The sums of a cell mostly lie across two cache lines.
  void prefetch_sums(std::int32_t at) const {
    const Moments& sums = sums_[static_cast<std::size_t>(at)];
    __builtin_prefetch(&sums.front());
    __builtin_prefetch(&sums.back());
  }
  /// Whether a ray comes from the other side of the surface than those of the map's points.
  static bool is_behind(const Cell& cell, const Eigen::Vector3f& ray) {
    const auto in = [&](std::size_t axis) { return static_cast<float>(cell.inwards[axis]); };
    return ray.x() * in(0) + ray.y() * in(1) + ray.z() * in(2) < 0.0F;
  }
  std::int32_t make(const CellKey& key);
  /// Finds those of the 27 cells around and including one that exist. Returns how many.
  std::size_t neighbours_of(const CellIndex& i, Neighbours& found) const;
  [[nodiscard]] Moments moments_around(std::span<const Neighbour> neighbours) const;
  [[nodiscard]] Eigen::Vector3f rays_around(std::span<const Neighbour> neighbours) const;
  void fit(Cell& cell) const;
  void remove(std::size_t slot);
  /// The first of the rows of a sensitivity that are kept: all, or the height's.
  [[nodiscard]] int first_row() const { return config_.level ? 2 : 0; }
  /// Where a row of a cell stands in sensitivity_rows_.
  [[nodiscard]] std::size_t row_of(std::size_t at, int row) const {
    const int first = first_row();
    return at * static_cast<std::size_t>(3 - first) + static_cast<std::size_t>(row - first);
  }
  /// The mean of the cell's own points, from its centre.
  [[nodiscard]] Eigen::Vector3f own_mean_of(std::size_t at) const {
    return points_of(sums_[at]) / count_of(sums_[at]);
  }
  /// The part of the radius of forget_beyond() for which there is room.
  [[nodiscard]] double radius_part() const;
  /// A removed cell has no place; the number of the next one stands there.
  static std::int32_t& next_free(Cell& removed) { return removed.index.x; }

  CellMapConfig config_;
  double per_m_;
  CellTable table_;
  std::vector<Cell> cells_;
  std::vector<Moments> sums_;                     // what insert() sums, from the cell's centre
  std::vector<Eigen::Vector3f> rays_;             // sums of unit vectors
  std::vector<SensitivityRow> sensitivity_rows_;  // sums as well, where they are asked for
  std::int32_t free_ = kNone;                     // the cell removed last; it names the one before
  std::size_t sweep_ = 0;
  std::uint32_t keyframe_ = 1;
  int used_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace lilo::core
