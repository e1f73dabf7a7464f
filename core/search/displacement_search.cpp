// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/displacement_search.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::core {
namespace {

constexpr std::size_t kNeighbours = 27;  // one step to either side, and the hypothesis itself

int coarse_steps_in(double radius, double step) {
  return static_cast<int>(std::ceil(radius / (search::kCoarseSteps * step)));
}

double angle_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi));
}

/// Whether alignments from both would come to the same place.
bool are_alike(const Displacement& a, const Displacement& b) {
  return (a.along_m - b.along_m).norm() < search::kSamePlace_m &&
         angle_between(a.yaw_rad, b.yaw_rad) < search::kSamePlace_rad &&
         angle_between(a.begin_yaw_rad, b.begin_yaw_rad) < search::kSamePlace_rad;
}

}  // namespace

DisplacementSearch::DisplacementSearch(std::size_t most_features)
    : map_(most_features), thick_map_(most_features) {
  structure_.reserve(most_features);
  points_.reserve(most_features);
  const auto width = [](double radius, double step) {
    return 2 * static_cast<std::size_t>(coarse_steps_in(radius, step)) + 1;
  };
  const std::size_t across = width(kFarthest.along_m, search::kPlaceStep_m);
  hypotheses_.reserve(across * across * width(kFarthest.yaw_rad, search::kYawStep_rad) +
                      search::kRefinedPlaces * kNeighbours);
}

void DisplacementSearch::set_map(const CellMap& structure, const Eigen::Vector3d& center_m) {
  center_m_ = center_m.head<2>();
  map_.clear();
  thick_map_.clear();
  structure.for_each_mean([&](const Eigen::Vector3d& mean_m) {
    const Eigen::Vector2d from_center_m = mean_m.head<2>() - center_m_;
    map_.add(from_center_m, search::kMapAround);
    thick_map_.add(from_center_m, search::kCoarseSteps * search::kMapAround);
  });
}

std::span<const Displacement> DisplacementSearch::find(const std::vector<Feature>& features,
                                                       const Trajectory& predicted,
                                                       const SearchRadius& radius, Onset onset) {
  onset_ = onset;
  structure_.assign(features);
  begin_ = predicted.at(0.0);
  end_ = predicted.end();
  hypotheses_.clear();
  try_all(radius);
  refine_best(radius.along_m > 0.0 ? 1 : 0);
  choose();
  return std::span(found_).first(found_count_);
}

void DisplacementSearch::try_all(const SearchRadius& radius) {
  const int farthest =
      coarse_steps_in(std::min(radius.along_m, kFarthest.along_m), search::kPlaceStep_m);
  const int turns =
      coarse_steps_in(std::min(radius.yaw_rad, kFarthest.yaw_rad), search::kYawStep_rad);
  const int begin_turns = coarse_steps_in(radius.begin_yaw_rad, search::kYawStep_rad);
  const double step_rad = search::kCoarseSteps * search::kYawStep_rad;
  for (int yaw = -turns; yaw <= turns; ++yaw) {
    const double yaw_rad = step_rad * yaw;
    if (onset_ == Onset::before_scan) {
      try_turned({{0.0, 0.0}, yaw_rad, yaw_rad}, farthest);
      continue;
    }
    for (int begin = -begin_turns; begin <= begin_turns; ++begin) {
      try_turned({{0.0, 0.0}, yaw_rad, step_rad * begin}, farthest);
    }
  }
}

/// At all places that are so many coarse steps away, at most.
void DisplacementSearch::try_turned(const Displacement& turned, int farthest) {
  turn(thick_map_, turned);
  Displacement by = turned;
  for (int x = -farthest; x <= farthest; ++x) {
    for (int y = -farthest; y <= farthest; ++y) {
      if (x * x + y * y > farthest * farthest) continue;
      by.along_m = search::kCoarseSteps * search::kPlaceStep_m * Eigen::Vector2d(x, y);
      score(thick_map_, by);
    }
  }
}

/// By one step of yaw, and by so many along. Afterwards only the hypotheses scored on the finer map
/// are left.
void DisplacementSearch::refine_best(int along) {
  const std::size_t best = std::min(search::kRefinedPlaces, hypotheses_.size());
  const auto end_of_best = hypotheses_.begin() + static_cast<std::ptrdiff_t>(best);
  std::partial_sort(hypotheses_.begin(), end_of_best, hypotheses_.end(),
                    [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  hypotheses_.erase(end_of_best, hypotheses_.end());
  for (std::size_t k = 0; k < best; ++k) {
    const Displacement middle = hypotheses_[k].by;
    for (int yaw = -1; yaw <= 1; ++yaw) {
      Displacement by = middle;
      by.yaw_rad += search::kYawStep_rad * yaw;
      if (onset_ == Onset::before_scan) by.begin_yaw_rad = by.yaw_rad;
      turn(map_, by);
      for (int x = -along; x <= along; ++x) {
        for (int y = -along; y <= along; ++y) {
          by.along_m = middle.along_m + search::kPlaceStep_m * Eigen::Vector2d(x, y);
          score(map_, by);
        }
      }
    }
  }
  hypotheses_.erase(hypotheses_.begin(), hypotheses_.begin() + static_cast<std::ptrdiff_t>(best));
}

/// The best hypotheses, of those alike the best one.
void DisplacementSearch::choose() {
  for (found_count_ = 0; found_count_ < search::kMostPlaces && !hypotheses_.empty();
       ++found_count_) {
    const Displacement best =
        std::max_element(hypotheses_.begin(), hypotheses_.end(), has_lower_score)->by;
    found_[found_count_] = best;
    std::erase_if(hypotheses_, [&](const Hypothesis& other) { return are_alike(other.by, best); });
  }
}

/// For displacements with that turn. The sensor's way during the scan turns with it.
void DisplacementSearch::turn(TopDownGrid& map, const Displacement& turned) {
  const Eigen::Quaterniond at_begin(so3_exp({0.0, 0.0, turned.begin_yaw_rad})),
      at_end(so3_exp({0.0, 0.0, turned.yaw_rad}));
  points_.assign_turning(structure_, at_begin * begin_.rotation, at_end * end_.rotation,
                         Subsample::quarter);
  const Eigen::Vector2d way_m = (end_.translation_m - begin_.translation_m).head<2>();
  const Eigen::Vector2d end_m = end_.translation_m.head<2>() - center_m_;
  const double most_m = kFarthest.along_m + (search::kCoarseSteps + 1.0) * search::kPlaceStep_m;
  map.place(points_, end_m - Eigen::Rotation2Dd(turned.begin_yaw_rad) * way_m, end_m,
            Subsample::quarter, static_cast<int>(most_m * search::kCellsPerMetre));
}

/// After turn() on the same map.
void DisplacementSearch::score(const TopDownGrid& map, const Displacement& by) {
  const Eigen::Vector2d cells = static_cast<double>(search::kCellsPerMetre) * by.along_m;
  hypotheses_.push_back({by, map.hits(static_cast<int>(std::lround(cells.x())),
                                      static_cast<int>(std::lround(cells.y())))});
}

}  // namespace lilo::core
