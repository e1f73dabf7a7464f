// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/cell_map.hpp"

#include "core/constants.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lilo::core {
namespace {

/// The direction, scaled so that its largest part is the largest integer.
std::array<std::int16_t, 3> direction_of(const Eigen::Vector3f& v) {
  const float largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0.0F)) return {};
  const Eigen::Vector3f scaled =
      v * (static_cast<float>(std::numeric_limits<std::int16_t>::max()) / largest);
  return {static_cast<std::int16_t>(scaled.x()), static_cast<std::int16_t>(scaled.y()),
          static_cast<std::int16_t>(scaled.z())};
}

}  // namespace

CellMap::CellMap(const CellMapConfig& config)
    : config_(config),
      per_m_(1.0 / static_cast<double>(config.cell_m)),
      table_(static_cast<std::size_t>(config.capacity)) {
  const auto capacity = static_cast<std::size_t>(config.capacity);
  cells_.reserve(capacity);
  sums_.reserve(capacity);
  rays_.assign(capacity, Eigen::Vector3f::Zero());
  if (config.with_sensitivity) {
    sensitivity_rows_.assign(row_of(capacity, first_row()), SensitivityRow::Zero());
  }
}

std::int32_t CellMap::make(const CellKey& key) {
  if (used_ == config_.capacity) {
    ++refused_;
    return kNone;
  }
  auto at = static_cast<std::int32_t>(cells_.size());
  if (free_ == kNone) {
    cells_.emplace_back();
    sums_.emplace_back();
  } else {
    at = free_;
    free_ = next_free(cells_[static_cast<std::size_t>(at)]);
    cells_[static_cast<std::size_t>(at)] = Cell{};
    sums_[static_cast<std::size_t>(at)] = Moments{};
  }
  rays_[static_cast<std::size_t>(at)].setZero();
  for (int row = first_row(); row < 3 && config_.with_sensitivity; ++row) {
    sensitivity_rows_[row_of(static_cast<std::size_t>(at), row)].setZero();
  }
  table_.insert(key.bucket, CellTable::tag_of(key.index), at);
  ++used_;
  cells_[static_cast<std::size_t>(at)].index = key.index;
  cells_[static_cast<std::size_t>(at)].born = keyframe_;
  return at;
}

std::size_t CellMap::neighbours_of(const CellIndex& i, Neighbours& found) const {
  std::array<std::size_t, Neighbours{}.size()> buckets;
  std::array<std::uint32_t, Neighbours{}.size()> tags;
  std::size_t n = 0;
  for (std::int32_t x = -1; x <= 1; ++x) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      const CellIndex lowest{i.x + x, i.y + y, i.z - 1};
      std::size_t bucket = table_.bucket_of(lowest);
      std::uint32_t tag = CellTable::tag_of(lowest);
      for (int level = 0; level < 3; ++level, ++n) {
        buckets[n] = bucket;
        tags[n] = tag;
        table_.prefetch(bucket);
        bucket = table_.bucket_above(bucket);
        tag = CellTable::tag_above(tag);
      }
    }
  }
  const std::array<float, 3> across_m{-config_.cell_m, 0.0F, config_.cell_m};
  std::size_t count = 0;
  n = 0;
  for (const float x_m : across_m) {
    for (const float y_m : across_m) {
      for (const float z_m : across_m) {
        const std::int32_t at = table_.find(buckets[n], tags[n]);
        ++n;
        if (at == kNone) continue;
        prefetch_sums(at);
        found[count++] = {at, x_m, y_m, z_m};
      }
    }
  }
  return count;
}

Moments CellMap::moments_around(std::span<const Neighbour> neighbours) const {
  Moments sums{};
  for (const Neighbour& o : neighbours) {
    const Moments& one = sums_[static_cast<std::size_t>(o.at)];
    const Eigen::Vector3f p = points_of(one);
    const Eigen::Vector3f q = p + count_of(one) * Eigen::Vector3f(o.x_m, o.y_m, o.z_m);
    // The squares: o p' + p o' + count o o'
    const Moments moved{count_of(one),
                        q.x(),
                        q.y(),
                        q.z(),
                        one[4] + o.x_m * (p.x() + q.x()),
                        one[5] + (o.x_m * q.y() + o.y_m * p.x()),
                        one[6] + (o.x_m * q.z() + o.z_m * p.x()),
                        one[7] + o.y_m * (p.y() + q.y()),
                        one[8] + (o.y_m * q.z() + o.z_m * p.y()),
                        one[9] + o.z_m * (p.z() + q.z())};
    for (std::size_t m = 0; m < sums.size(); ++m) sums[m] += moved[m];
  }
  return sums;
}

Eigen::Vector3f CellMap::rays_around(std::span<const Neighbour> neighbours) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Neighbour& o : neighbours) sum += rays_[static_cast<std::size_t>(o.at)];
  return sum;
}

CellMap::MeanSensitivity CellMap::sensitivity_around(std::int32_t at) const {
  MeanSensitivity around;
  if (!config_.with_sensitivity) return around;
  const CellIndex& index = cells_[static_cast<std::size_t>(at)].index;
  Neighbours neighbours;
  const std::size_t n = neighbours_of(index, neighbours);
  float count = 0.0F;
  Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
  for (const Neighbour& o : std::span(neighbours).first(n)) {
    const auto one = static_cast<std::size_t>(o.at);
    for (int row = first_row(); row < 3; ++row) {
      around.sensitivity.row(row) += sensitivity_rows_[row_of(one, row)];
    }
    count += count_of(sums_[one]);
    sum_m += points_of(sums_[one]) + count_of(sums_[one]) * Eigen::Vector3f(o.x_m, o.y_m, o.z_m);
  }
  around.sensitivity /= count;
  around.mean_m = center_of(index) + (sum_m / count).cast<double>();
  return around;
}

void CellMap::subtract_sensitivity(const PoseSensitivity& rigid) {
  if (!config_.with_sensitivity) return;
  for (const CellTable::Slot& slot : table_.slots()) {
    if (slot.at == kNone) continue;
    const auto at = static_cast<std::size_t>(slot.at);
    const Eigen::Vector3d mean_m = center_of(cells_[at].index) + own_mean_of(at).cast<double>();
    const Sensitivity moved = count_of(sums_[at]) * rigid.at(mean_m);
    for (int row = first_row(); row < 3; ++row)
      sensitivity_rows_[row_of(at, row)] -= moved.row(row);
  }
}

void CellMap::fit(Cell& cell) const {
  const std::uint32_t age = keyframe_ - cell.born;
  cell.refit_at = keyframe_ + std::max(1U, age / 2);
  cell.information.setZero();
  Neighbours around;
  const auto neighbours = std::span(around).first(neighbours_of(cell.index, around));
  const Moments sums = moments_around(neighbours);
  const float count = count_of(sums);
  cell.is_known = count >= map::kMinPoints;
  if (!cell.is_known) return;
  cell.mean_m = points_of(sums) / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(matrix_of<float>(squares_of(sums) / count - outer(cell.mean_m)));
  const float thin_m = map::kThinSpread * 3.0F * config_.cell_m;
  const float point_m = age < map::kYoungCell ? map::kYoungPoint_m : map::kPoint_m;
  const float doubt = config_.noise_m * config_.noise_m + point_m * point_m / count;
  // A strip of ground is thin in two directions, and could be tilted in any way about its length.
  if (config_.level && (solver.eigenvalues()[1] < thin_m * thin_m ||
                        std::abs(solver.eigenvectors()(2, 0)) < map::kUprightCosine)) {
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const float variance = std::max(solver.eigenvalues()[k], 0.0F) + doubt;
    const float weight = std::max(0.0F, 1.0F / variance - 1.0F / (thin_m * thin_m));
    cell.information += weight * outer(solver.eigenvectors().col(k));
  }
  cell.inwards = direction_of(matrix_of(cell.information) * rays_around(neighbours));
}

void CellMap::clear() {
  for (const Cell& cell : cells_) table_.clear_from(table_.bucket_of(cell.index));
  cells_.clear();
  sums_.clear();
  free_ = kNone;
  used_ = 0;
}

void CellMap::remove(std::size_t slot) {
  const std::int32_t removed = table_.slots()[slot].at;
  --used_;
  table_.remove(slot, [this](std::int32_t at) {
    return table_.bucket_of(cells_[static_cast<std::size_t>(at)].index);
  });
  next_free(cells_[static_cast<std::size_t>(removed)]) = free_;
  free_ = removed;
}

double CellMap::radius_part() const {
  const double filled = static_cast<double>(used_) / config_.capacity;
  const double beyond = std::max(0.0, filled - map::kNearlyFull) / (1.0 - map::kNearlyFull);
  return 1.0 - (1.0 - map::kFullRadius) * beyond;
}

void CellMap::forget_beyond(const Eigen::Vector3d& center_m, double radius_m) {
  radius_m *= radius_part();
  const std::vector<CellTable::Slot>& slots = table_.slots();
  const std::size_t share = slots.size() / map::kSweepScans;
  const CellIndex center = index_of(center_m);
  const std::uint32_t center_tag = CellTable::tag_of(center);
  const Eigen::Vector3d rest_m = center_of(center) - center_m;
  const auto cell_m = static_cast<double>(config_.cell_m);
  for (std::size_t n = 0; n < share; ++n) {
    // The tag tells where a cell is; to read every cell would take most of the time.
    if (slots[sweep_].at != kNone) {
      const CellIndex from = CellTable::between(center_tag, slots[sweep_].tag);
      const Eigen::Vector3d from_m = cell_m * Eigen::Vector3d(from.x, from.y, from.z) + rest_m;
      if (from_m.squaredNorm() > radius_m * radius_m) {
        remove(sweep_);
        continue;  // another cell may have moved into this slot
      }
    }
    sweep_ = table_.after(sweep_);
  }
}

}  // namespace lilo::core
