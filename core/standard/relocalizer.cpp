#include "core/standard/relocalizer.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::standard {
namespace {

// The finer map is drawn three of Footprint's cells wide and the thick one five, so that whatever
// lies between two steps is met by one of them; at 20 m a turn moves things as far as a step.
constexpr int kAround = 1, kThickAround = 2;
constexpr double kStep_m = 1.0, kStep_rad = 0.05;
constexpr double kWide = 2.0;  // steps, on the thick map
constexpr std::size_t kLookedAround = 12;
constexpr std::size_t kAroundEach = 27;  // one step to either side

int wide_steps_in(double reach, double step) {
  return static_cast<int>(std::ceil(reach / (kWide * step)));
}

/// Whether alignments from both would come to the same place.
bool are_alike(const Displacement& a, const Displacement& b) {
  constexpr double kAlong_m = 1.5, kYaw_rad = 0.1;
  return (a.along_m - b.along_m).norm() < kAlong_m && std::abs(a.yaw_rad - b.yaw_rad) < kYaw_rad;
}

}  // namespace

Pose displaced(const Pose& T, const Displacement& by) {
  return {(so3_exp({0.0, 0.0, by.yaw_rad}) * T.rotation).normalized(),
          T.translation_m + Eigen::Vector3d(by.along_m.x(), by.along_m.y(), 0.0)};
}

Relocalizer::Relocalizer(std::size_t most_features)
    : map_(most_features), thick_map_(most_features) {
  outline_.reserve(most_features);
  plan_.reserve(most_features);
  const auto width = [](double reach, double step) {
    return 2 * static_cast<std::size_t>(wide_steps_in(reach, step)) + 1;
  };
  const std::size_t across = width(kFarthest.along_m, kStep_m);
  looks_.reserve(across * across * width(kFarthest.yaw_rad, kStep_rad) +
                 kLookedAround * kAroundEach);
}

void Relocalizer::set_map(const CellMap& structure, const Eigen::Vector3d& center_m) {
  center_m_ = center_m.head<2>();
  map_.clear();
  thick_map_.clear();
  structure.for_each_mean([&](const Eigen::Vector3d& mean_m) {
    const Eigen::Vector2d from_center_m = mean_m.head<2>() - center_m_;
    map_.add(from_center_m, kAround);
    thick_map_.add(from_center_m, kThickAround);
  });
}

std::span<const Displacement> Relocalizer::search(const std::vector<Feature>& features,
                                                  const Trajectory& predicted, const Reach& reach) {
  outline_.assign(features);
  begin_ = predicted.at(0.0);
  end_ = predicted.end();
  looks_.clear();
  look_everywhere(reach);
  look_around_the_best();
  choose();
  return std::span(places_).first(place_count_);
}

void Relocalizer::look_everywhere(const Reach& reach) {
  const int farthest = wide_steps_in(std::min(reach.along_m, kFarthest.along_m), kStep_m);
  const int turns = wide_steps_in(std::min(reach.yaw_rad, kFarthest.yaw_rad), kStep_rad);
  for (int yaw = -turns; yaw <= turns; ++yaw) {
    const double yaw_rad = kWide * kStep_rad * yaw;
    turn(thick_map_, yaw_rad);
    for (int x = -farthest; x <= farthest; ++x) {
      for (int y = -farthest; y <= farthest; ++y) {
        if (x * x + y * y > farthest * farthest) continue;
        look(thick_map_, {kWide * kStep_m * Eigen::Vector2d(x, y), yaw_rad});
      }
    }
  }
}

/// Leaves the looks on the finer map alone.
void Relocalizer::look_around_the_best() {
  const std::size_t best = std::min(kLookedAround, looks_.size());
  const auto end_of_best = looks_.begin() + static_cast<std::ptrdiff_t>(best);
  std::partial_sort(looks_.begin(), end_of_best, looks_.end(),
                    [](const Look& a, const Look& b) { return a.returns > b.returns; });
  looks_.erase(end_of_best, looks_.end());
  for (std::size_t k = 0; k < best; ++k) {
    const Displacement middle = looks_[k].by;
    for (int yaw = -1; yaw <= 1; ++yaw) {
      const double yaw_rad = middle.yaw_rad + kStep_rad * yaw;
      turn(map_, yaw_rad);
      for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
          look(map_, {middle.along_m + kStep_m * Eigen::Vector2d(x, y), yaw_rad});
        }
      }
    }
  }
  looks_.erase(looks_.begin(), looks_.begin() + static_cast<std::ptrdiff_t>(best));
}

/// The best looks, of those alike the best one.
void Relocalizer::choose() {
  for (place_count_ = 0; place_count_ < kMostPlaces && !looks_.empty(); ++place_count_) {
    const Displacement best =
        std::max_element(looks_.begin(), looks_.end(), [](const Look& a, const Look& b) {
          return a.returns < b.returns;
        })->by;
    places_[place_count_] = best;
    std::erase_if(looks_, [&](const Look& other) { return are_alike(other.by, best); });
  }
}

/// For looks with that turn, at most so far along. The sensor's way during the scan turns with it.
void Relocalizer::turn(Footprint& map, double yaw_rad) {
  const Displacement by{{0.0, 0.0}, yaw_rad};
  plan_.assign(outline_, displaced(begin_, by).rotation, displaced(end_, by).rotation,
               Share::quarter);
  const Eigen::Vector2d way_m = (end_.translation_m - begin_.translation_m).head<2>();
  const Eigen::Vector2d end_m = end_.translation_m.head<2>() - center_m_;
  constexpr double kMost_m = kFarthest.along_m + (kWide + 1.0) * kStep_m;
  map.aim(plan_, end_m - Eigen::Rotation2Dd(yaw_rad) * way_m, end_m, Share::quarter,
          static_cast<int>(kMost_m * Footprint::kPerMetre));
}

/// After turn() on the same map.
void Relocalizer::look(const Footprint& map, const Displacement& by) {
  const Eigen::Vector2d cells = static_cast<double>(Footprint::kPerMetre) * by.along_m;
  looks_.push_back({by, map.returns_on(static_cast<int>(std::lround(cells.x())),
                                       static_cast<int>(std::lround(cells.y())))});
}

}  // namespace lilo::standard
