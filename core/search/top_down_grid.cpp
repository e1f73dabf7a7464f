// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/top_down_grid.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lilo::core {
namespace {

constexpr std::int32_t kOutside = search::kGridCells * search::kGridCells;
constexpr float kPerMetre = search::kCellsPerMetre;

/// Of a place that no integer holds, nan among them, one just outside.
std::int32_t whole(float v) {
  v = v > -1.0F ? v : -1.0F;
  return static_cast<std::int32_t>(
      v < static_cast<float>(search::kGridCells) ? v : static_cast<float>(search::kGridCells));
}

std::int32_t cell_at(float x, float y) {
  const std::int32_t column = whole(x), row = whole(y);
  const bool outside = ((column | row) & -search::kGridCells) != 0;  // negative, or too large
  return outside ? kOutside : row * search::kGridCells + column;
}

/// From where to where a scan was taken, in cells from the grid's corner.
struct Sweep {
  Sweep(const Eigen::Vector2d& begin_m, const Eigen::Vector2d& end_m)
      : begin((kPerMetre * begin_m).cast<float>().array() +
              0.5F * static_cast<float>(search::kGridCells)),
        to_end((kPerMetre * (end_m - begin_m)).cast<float>()) {}
  [[nodiscard]] std::int32_t cell_of(const TopDownPoints& scan, std::size_t k) const {
    return cell_at(scan.x[k] + begin.x() + scan.s[k] * to_end.x(),
                   scan.y[k] + begin.y() + scan.s[k] * to_end.y());
  }
  Eigen::Vector2f begin, to_end;
};

/// How many of `size` structure points, in their order.
std::size_t count_in(Subsample subsample, std::size_t size) {
  return StructurePoints::before(subsample == Subsample::all ? search::kSubsample : 1, size);
}

}  // namespace

void StructurePoints::reserve(std::size_t size) {
  for (std::vector<float>* part : {&x_m, &y_m, &z_m, &s}) part->reserve(size);
}

std::size_t StructurePoints::before(std::size_t part, std::size_t size) {
  return part * (size / search::kSubsample) + std::min(part, size % search::kSubsample);
}

void StructurePoints::assign(const std::vector<Feature>& features) {
  const auto is_structure = [](const Feature& f) { return f.kind == FeatureKind::structure; };
  const auto size =
      static_cast<std::size_t>(std::count_if(features.begin(), features.end(), is_structure));
  for (std::vector<float>* part : {&x_m, &y_m, &z_m, &s}) part->resize(size);
  std::size_t n = 0;
  for (const Feature& f : features) {
    if (!is_structure(f)) continue;
    const std::size_t k = before(n % search::kSubsample, size) + n / search::kSubsample;
    x_m[k] = f.x_m;
    y_m[k] = f.y_m;
    z_m[k] = f.z_m;
    s[k] = f.s;
    ++n;
  }
}

void TopDownPoints::reserve(std::size_t size) {
  for (std::vector<float>* part : {&x, &y, &s}) part->reserve(size);
}

void TopDownPoints::assign(const StructurePoints& scan, const Eigen::Quaterniond& begin,
                           const Eigen::Quaterniond& end, Subsample subsample) {
  for (std::vector<float>* part : {&x, &y}) part->resize(scan.s.size());
  s = scan.s;
  // One attitude for all points: at a constant rate of turn its error is the same in every scan.
  const Eigen::Matrix<float, 2, 3> R =
      (kPerMetre * begin.slerp(0.5, end).toRotationMatrix().topRows<2>()).cast<float>();
  const float xx = R(0, 0), xy = R(0, 1), xz = R(0, 2);
  const float yx = R(1, 0), yy = R(1, 1), yz = R(1, 2);
  const std::size_t n = count_in(subsample, s.size());
  for (std::size_t k = 0; k < n; ++k) {
    x[k] = xx * scan.x_m[k] + xy * scan.y_m[k] + xz * scan.z_m[k];
    y[k] = yx * scan.x_m[k] + yy * scan.y_m[k] + yz * scan.z_m[k];
  }
}

void TopDownPoints::assign_turning(const StructurePoints& scan, const Eigen::Quaterniond& begin,
                                   const Eigen::Quaterniond& end, Subsample subsample) {
  std::array<Eigen::Matrix<float, 2, 3>, search::kTurnInstants> R;
  for (std::size_t k = 0; k < search::kTurnInstants; ++k) {
    const double middle = (static_cast<double>(k) + 0.5) / search::kTurnInstants;
    R[k] = (kPerMetre * begin.slerp(middle, end).toRotationMatrix().topRows<2>()).cast<float>();
  }
  for (std::vector<float>* part : {&x, &y}) part->resize(scan.s.size());
  s = scan.s;
  const std::size_t n = count_in(subsample, s.size());
  for (std::size_t k = 0; k < n; ++k) {
    const auto instant = static_cast<std::size_t>(s[k] * search::kTurnInstants);
    const Eigen::Vector2f seen = R[std::min(instant, search::kTurnInstants - 1)] *
                                 Eigen::Vector3f(scan.x_m[k], scan.y_m[k], scan.z_m[k]);
    x[k] = seen.x();
    y[k] = seen.y();
  }
}

TopDownGrid::TopDownGrid(std::size_t most) : at_(most), taken_(kOutside + 1) { clear(); }

void TopDownGrid::clear() {
  if (++now_ == 0) {
    std::fill(taken_.begin(), taken_.end(), 0);
    now_ = 1;
  }
  taken_.back() = now_;  // what is outside never counts
  occupied_ = 0;
}

void TopDownGrid::add(const TopDownPoints& scan, const Eigen::Vector2d& begin_m,
                      const Eigen::Vector2d& end_m, Subsample subsample) {
  const Sweep sweep(begin_m, end_m);
  const std::size_t n = std::min(count_in(subsample, scan.s.size()), at_.size());
  std::int32_t* at = at_.data();
  for (std::size_t k = 0; k < n; ++k) at[k] = sweep.cell_of(scan, k);
  std::uint8_t* taken = taken_.data();
  const std::uint8_t now = now_;
  int cells = 0;
  for (std::size_t k = 0; k < n; ++k) {
    cells += static_cast<int>(taken[at[k]] != now);
    taken[at[k]] = now;
  }
  occupied_ += cells;
}

void TopDownGrid::add(const Eigen::Vector2d& point_m, int around) {
  const Eigen::Vector2f from = Sweep(point_m, point_m).begin;
  for (int dy = -around; dy <= around; ++dy) {
    for (int dx = -around; dx <= around; ++dx) {
      std::uint8_t& taken = taken_[static_cast<std::size_t>(
          cell_at(from.x() + static_cast<float>(dx), from.y() + static_cast<float>(dy)))];
      occupied_ += static_cast<int>(taken != now_);
      taken = now_;
    }
  }
}

void TopDownGrid::place(const TopDownPoints& scan, const Eigen::Vector2d& begin_m,
                        const Eigen::Vector2d& end_m, Subsample subsample, int margin) {
  const Sweep sweep(begin_m, end_m);
  const std::size_t n = std::min(count_in(subsample, scan.s.size()), at_.size());
  placed_ = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::int32_t at = sweep.cell_of(scan, k);
    const std::int32_t x = at % search::kGridCells, y = at / search::kGridCells;
    at_[placed_] = at;
    placed_ += std::min(x, y) >= margin && std::max(x, y) < search::kGridCells - margin ? 1 : 0;
  }
}

int TopDownGrid::hits(int x, int y) const {
  const std::uint8_t* taken = taken_.data() + std::ptrdiff_t{y} * search::kGridCells + x;
  const std::uint8_t now = now_;
  int count = 0;
  for (std::size_t k = 0; k < placed_; ++k) count += static_cast<int>(taken[at_[k]] == now);
  return count;
}

}  // namespace lilo::core
