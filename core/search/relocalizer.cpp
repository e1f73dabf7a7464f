#include "core/search/relocalizer.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::core {
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

double differ(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi));
}

/// Whether alignments from both would come to the same place.
bool are_alike(const Displacement& a, const Displacement& b) {
  constexpr double kAlong_m = 1.5, kYaw_rad = 0.1;
  return (a.along_m - b.along_m).norm() < kAlong_m && differ(a.yaw_rad, b.yaw_rad) < kYaw_rad &&
         differ(a.begin_yaw_rad, b.begin_yaw_rad) < kYaw_rad;
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
                                                  const Trajectory& predicted, const Reach& reach,
                                                  Change change) {
  change_ = change;
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
  const int begin_turns =
      change_ == Change::during ? wide_steps_in(reach.begin_yaw_rad, kStep_rad) : 0;
  for (int yaw = -turns; yaw <= turns; ++yaw) {
    const double yaw_rad = kWide * kStep_rad * yaw;
    if (change_ == Change::before) look_at_turn({{0.0, 0.0}, yaw_rad, yaw_rad}, farthest);
    if (change_ == Change::before) continue;
    for (int begin = -begin_turns; begin <= begin_turns; ++begin) {
      look_at_turn({{0.0, 0.0}, yaw_rad, kWide * kStep_rad * begin}, farthest);
    }
  }
}

/// At all places that are so many wide steps away, at most.
void Relocalizer::look_at_turn(const Displacement& turned, int farthest) {
  turn(thick_map_, turned);
  Displacement by = turned;
  for (int x = -farthest; x <= farthest; ++x) {
    for (int y = -farthest; y <= farthest; ++y) {
      if (x * x + y * y > farthest * farthest) continue;
      by.along_m = kWide * kStep_m * Eigen::Vector2d(x, y);
      look(thick_map_, by);
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
      Displacement by = middle;
      by.yaw_rad += kStep_rad * yaw;
      if (change_ == Change::before) by.begin_yaw_rad = by.yaw_rad;
      turn(map_, by);
      for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
          by.along_m = middle.along_m + kStep_m * Eigen::Vector2d(x, y);
          look(map_, by);
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
void Relocalizer::turn(Footprint& map, const Displacement& turned) {
  const Eigen::Quaterniond at_begin(so3_exp({0.0, 0.0, turned.begin_yaw_rad})),
      at_end(so3_exp({0.0, 0.0, turned.yaw_rad}));
  plan_.assign_turning(outline_, at_begin * begin_.rotation, at_end * end_.rotation,
                       Share::quarter);
  const Eigen::Vector2d way_m = (end_.translation_m - begin_.translation_m).head<2>();
  const Eigen::Vector2d end_m = end_.translation_m.head<2>() - center_m_;
  constexpr double kMost_m = kFarthest.along_m + (kWide + 1.0) * kStep_m;
  map.aim(plan_, end_m - Eigen::Rotation2Dd(turned.begin_yaw_rad) * way_m, end_m, Share::quarter,
          static_cast<int>(kMost_m * Footprint::kPerMetre));
}

/// After turn() on the same map.
void Relocalizer::look(const Footprint& map, const Displacement& by) {
  const Eigen::Vector2d cells = static_cast<double>(Footprint::kPerMetre) * by.along_m;
  looks_.push_back({by, map.returns_on(static_cast<int>(std::lround(cells.x())),
                                       static_cast<int>(std::lround(cells.y())))});
}

}  // namespace lilo::core
