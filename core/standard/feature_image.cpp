#include "core/standard/feature_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::standard {
namespace {

// Ground seen from a tilted sensor or on a hill stays below this slope, walls and trunks above.
constexpr float kSteep = 0.84F;  // tan 40 degrees
// Two returns belong to one surface when they are not much farther apart than the rings would be
// on a surface of that slope.
constexpr float kSameSurface = 3.0F;

}  // namespace

const std::vector<Feature>& FeatureImage::build(const Scan& scan, double min_range_m,
                                                double max_range_m) {
  project(scan, min_range_m, max_range_m);
  features_.clear();
  for (int j = 0; j < columns_; ++j) {
    classify_column(scan.beams, pixels_.data() + static_cast<std::ptrdiff_t>(j) * rows_);
  }
  return features_;
}

void FeatureImage::project(const Scan& scan, double min_range_m, double max_range_m) {
  rows_ = scan.beams.ring_count;
  pixels_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_), Pixel{});
  const auto duration_ns =
      static_cast<float>(std::max<std::int64_t>(scan.end_ns - scan.start_ns, 1));
  const float per_ns = 1.0F / duration_ns;
  const float per_rad = static_cast<float>(columns_) / (2.0F * std::numbers::pi_v<float>);
  const auto near2 = static_cast<float>(min_range_m * min_range_m);
  const auto far2 = static_cast<float>(max_range_m * max_range_m);
  for (const Return& r : scan.returns) {
    const float flat2 = r.x_m * r.x_m + r.y_m * r.y_m;
    const float range2 = flat2 + r.z_m * r.z_m;
    if (!(range2 >= near2 && range2 <= far2) || r.ring >= rows_) continue;  // drops NaN as well
    const int column = static_cast<int>((std::numbers::pi_v<float> - r.azimuth_rad) * per_rad);
    const int wrapped = std::clamp(column < columns_ ? column : column - columns_, 0, columns_ - 1);
    Pixel& pixel =
        pixels_[static_cast<std::size_t>(wrapped) * static_cast<std::size_t>(rows_) + r.ring];
    if (pixel.flat_m > 0.0F) continue;
    const float s = scan.motion_compensated ? 1.0F : static_cast<float>(r.t_ns) * per_ns;
    pixel = {r.x_m, r.y_m, r.z_m, std::sqrt(flat2), std::clamp(s, 0.0F, 1.0F)};
  }
}

FeatureImage::Step FeatureImage::step_between(const Pixel& lower, const Pixel& upper,
                                              float gap_rad) {
  if (lower.flat_m <= 0.0F || upper.flat_m <= 0.0F) return {};
  const float dd = upper.flat_m - lower.flat_m;
  const float dz = upper.z_m - lower.z_m;
  const bool steep = std::abs(dz) > kSteep * std::abs(dd);
  // Rings are range * gap apart across the ray, and farther on what the ray grazes.
  const float across_m = lower.flat_m * gap_rad;
  const float grazing = std::max(std::abs(lower.z_m) / lower.flat_m, gap_rad);
  const float reach_m = kSameSurface * (steep ? across_m : across_m / grazing);
  return {dd * dd + dz * dz < reach_m * reach_m, steep};
}

void FeatureImage::classify_column(const BeamTable& beams, const Pixel* column) {
  Step below;
  for (int ring = 0; ring < rows_; ++ring) {
    Step above;
    if (ring + 1 < rows_) {
      const auto k = static_cast<std::size_t>(ring);
      above = step_between(column[ring], column[ring + 1],
                           beams.elevation_rad[k + 1] - beams.elevation_rad[k]);
    }
    if (column[ring].flat_m > 0.0F) add_feature(column, ring, below, above);
    below = above;
  }
}

void FeatureImage::add_feature(const Pixel* column, int ring, Step below, Step above) {
  const Pixel& p = column[ring];
  const bool flat = (above.connected && !above.steep) || (below.connected && !below.steep);
  const bool steep = (above.connected && above.steep) || (below.connected && below.steep);
  if (flat && steep) return;          // a kerb or the foot of a wall: neither
  if (flat && p.z_m >= 0.0F) return;  // a roof or a canopy seen from below
  Feature f{p.x_m,
            p.y_m,
            p.z_m,
            p.s,
            0.0F,
            0.0F,
            0.0F,
            flat ? Kind::ground : Kind::structure,
            static_cast<std::uint8_t>(ring)};
  if (above.connected || below.connected) {
    const Pixel& neighbour = above.connected ? column[ring + 1] : column[ring - 1];
    f.dx_m = neighbour.x_m - p.x_m;
    f.dy_m = neighbour.y_m - p.y_m;
    f.dz_m = neighbour.z_m - p.z_m;
  }
  features_.push_back(f);
}

}  // namespace lilo::standard
