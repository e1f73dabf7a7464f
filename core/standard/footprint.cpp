#include "core/standard/footprint.hpp"

#include "core/standard/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::standard {
namespace {

constexpr int kSide = 512;       // cells; 256 m, what lies beyond is left out
constexpr float kCell_m = 0.5F;  // a trunk or a post with its blur

}  // namespace

Footprint::Footprint() : taken_(std::size_t{kSide} * kSide / 64) {}

void Footprint::clear() {
  std::fill(taken_.begin(), taken_.end(), 0);
  cells_ = 0;
}

void Footprint::add(const std::vector<Feature>& features, double start_s, double span_s,
                    const Twist& twist) {
  constexpr float kPerCell = 1.0F / kCell_m;
  const Pose middle = moved({}, twist, start_s + 0.5 * span_s);
  // Within one scan the turn is small: the middle of it serves all, the way travelled each its own.
  const Eigen::Matrix3f rotation = middle.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f origin_m = middle.translation_m.cast<float>();
  const Eigen::Vector3f way_m = (middle.rotation * twist.linear_mps * span_s).cast<float>();
  for (const Feature& f : features) {
    if (f.kind != Kind::structure) continue;
    const Eigen::Vector3f p =
        rotation * Eigen::Vector3f(f.x_m, f.y_m, f.z_m) + origin_m + (f.s - 0.5F) * way_m;
    const int x = static_cast<int>(std::floor(p.x() * kPerCell)) + kSide / 2;
    const int y = static_cast<int>(std::floor(p.y() * kPerCell)) + kSide / 2;
    if (x < 0 || x >= kSide || y < 0 || y >= kSide) continue;
    const auto at = static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x);
    const std::uint64_t bit = std::uint64_t{1} << (at % 64);
    if ((taken_[at / 64] & bit) == 0) ++cells_;
    taken_[at / 64] |= bit;
  }
}

}  // namespace lilo::standard
