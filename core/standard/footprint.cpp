#include "core/standard/footprint.hpp"

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

void Footprint::add(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end) {
  constexpr float kPerCell = 1.0F / kCell_m;
  constexpr auto kSide_f = static_cast<float>(kSide);
  // Within one scan the turn is small: the middle of it serves all, the way travelled each its own.
  const Eigen::Matrix<float, 2, 3> R =
      (kPerCell * T_begin.rotation.slerp(0.5, T_end.rotation).toRotationMatrix().topRows<2>())
          .cast<float>();
  const Eigen::Vector2f begin =
      (kPerCell * T_begin.translation_m.head<2>()).cast<float>().array() + 0.5F * kSide_f;
  const Eigen::Vector2f way =
      (kPerCell * (T_end.translation_m - T_begin.translation_m).head<2>()).cast<float>();
  for (const Feature& f : features) {
    if (f.kind != Kind::structure) continue;
    const float x = R(0, 0) * f.x_m + R(0, 1) * f.y_m + R(0, 2) * f.z_m + begin.x() + f.s * way.x();
    const float y = R(1, 0) * f.x_m + R(1, 1) * f.y_m + R(1, 2) * f.z_m + begin.y() + f.s * way.y();
    if (!(x >= 0.0F && x < kSide_f && y >= 0.0F && y < kSide_f)) continue;
    const auto at = static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x);
    const std::uint64_t bit = std::uint64_t{1} << (at % 64);
    cells_ += static_cast<int>((taken_[at / 64] & bit) == 0);
    taken_[at / 64] |= bit;
  }
}

}  // namespace lilo::standard
