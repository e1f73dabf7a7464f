#include "core/standard/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::standard {
namespace {

constexpr std::uint32_t kSide = 512;  // cells; 256 m
constexpr std::uint32_t kOutside = kSide * kSide;
constexpr float kPerMetre = 2.0F;  // cells: as wide as a trunk or a post with its blur

}  // namespace

void Outline::reserve(std::size_t size) {
  for (std::vector<float>* part : {&x_m, &y_m, &z_m, &s}) part->reserve(size);
}

std::size_t Outline::before(std::size_t part, std::size_t size) {
  return part * (size / kParts) + std::min(part, size % kParts);
}

void Outline::assign(const std::vector<Feature>& features) {
  const auto stands = [](const Feature& f) { return f.kind == Kind::structure; };
  const auto size =
      static_cast<std::size_t>(std::count_if(features.begin(), features.end(), stands));
  for (std::vector<float>* part : {&x_m, &y_m, &z_m, &s}) part->resize(size);
  std::size_t n = 0;
  for (const Feature& f : features) {
    if (!stands(f)) continue;
    const std::size_t k = before(n % kParts, size) + n / kParts;
    x_m[k] = f.x_m;
    y_m[k] = f.y_m;
    z_m[k] = f.z_m;
    s[k] = f.s;
    ++n;
  }
}

Footprint::Footprint(std::size_t most) : at_(most), taken_(kOutside / 64 + 1) { clear(); }

void Footprint::clear() {
  std::fill(taken_.begin(), taken_.end(), 0);
  taken_.back() = 1;  // what is outside never counts
  cells_ = 0;
}

void Footprint::add(const Outline& scan, const Pose& T_begin, const Pose& T_end, Share share) {
  constexpr auto kEdge = static_cast<float>(kSide);
  // Within one scan the turn is small: the middle of it serves all, the way travelled each its own.
  const Eigen::Matrix<float, 2, 3> R =
      (kPerMetre * T_begin.rotation.slerp(0.5, T_end.rotation).toRotationMatrix().topRows<2>())
          .cast<float>();
  const Eigen::Vector2f begin =
      (kPerMetre * T_begin.translation_m.head<2>()).cast<float>().array() + 0.5F * kEdge;
  const Eigen::Vector2f way =
      (kPerMetre * (T_end.translation_m - T_begin.translation_m).head<2>()).cast<float>();
  const float xx = R(0, 0), xy = R(0, 1), xz = R(0, 2), x0 = begin.x(), xs = way.x();
  const float yx = R(1, 0), yy = R(1, 1), yz = R(1, 2), y0 = begin.y(), ys = way.y();
  const std::size_t part = share == Share::all ? Outline::kParts : 1;
  const std::size_t n = std::min(Outline::before(part, scan.s.size()), at_.size());
  std::uint32_t* at = at_.data();
  for (std::size_t k = 0; k < n; ++k) {
    const float x = xx * scan.x_m[k] + xy * scan.y_m[k] + xz * scan.z_m[k] + x0 + scan.s[k] * xs;
    const float y = yx * scan.x_m[k] + yy * scan.y_m[k] + yz * scan.z_m[k] + y0 + scan.s[k] * ys;
    const bool inside = (x >= 0.0F) & (x < kEdge) & (y >= 0.0F) & (y < kEdge);
    const auto cell = static_cast<std::int32_t>(y) * static_cast<std::int32_t>(kSide) +
                      static_cast<std::int32_t>(x);
    at[k] = inside ? static_cast<std::uint32_t>(cell) : kOutside;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint64_t bit = std::uint64_t{1} << (at[k] % 64);
    cells_ += static_cast<int>((taken_[at[k] / 64] & bit) == 0);
    taken_[at[k] / 64] |= bit;
  }
}

}  // namespace lilo::standard
