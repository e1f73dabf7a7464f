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
// The lasers of one firing look up to 18 degrees apart (HDL-64E). Columns nearer to the front, and
// those around the scan's first return, where it ends as well, may still get returns.
constexpr float kSpread_rad = 0.35F;

// From the return of a ring to that of the next: not on one surface, or on one that is
constexpr std::int32_t kFlatStep = 1, kSteepStep = 2;

float columns_per_rad(int columns) {
  return static_cast<float>(columns) / (2.0F * std::numbers::pi_v<float>);
}

}  // namespace

FeatureImage::FeatureImage(int columns, RangeLimits limits)
    : columns_(columns),
      margin_(static_cast<int>(std::ceil(kSpread_rad * columns_per_rad(columns)))),
      nearest2_(static_cast<float>(limits.min_m * limits.min_m)),
      farthest2_(static_cast<float>(limits.max_m * limits.max_m)) {}

const std::vector<Feature>& FeatureImage::build(const Scan& scan) {
  begin(scan.beams);
  project(scan.returns);
  return finish(scan);
}

void FeatureImage::begin(const BeamTable& beams) {
  beams_ = beams;
  const int gaps = beams.ring_count - 1;
  for (int ring = 0; ring <= gaps; ++ring) {  // above the highest as below it
    const auto k = static_cast<std::size_t>(std::max(0, std::min(ring, gaps - 1)));
    gap_rad_[static_cast<std::size_t>(ring)] =
        gaps > 0 ? beams.elevation_rad[k + 1] - beams.elevation_rad[k] : 0.0F;
  }
  const auto size = static_cast<std::size_t>(beams.ring_count) * static_cast<std::size_t>(columns_);
  pixels_.resize(size + 1);
  filled_.assign(static_cast<std::size_t>(columns_), Filled{});
  for (std::vector<Feature>* features : {&features_, &last_features_}) {
    if (features->capacity() < size) features->resize(size);  // touches it all
    features->clear();
  }
  first_column_ = -1;
  front_ = classified_ = 0;
  disturbed_ = false;
}

void FeatureImage::add(std::span<const Return> returns) {
  project(returns);
  if (!disturbed_) classify_until(front_ - margin_);
}

std::vector<Feature>& FeatureImage::finish(const Scan& scan) {
  if (disturbed_ || classified_ == 0) {
    features_.clear();
    for (int column = 0; column < columns_; ++column) classify_column(column, features_);
  } else {
    classify_until(columns_);
    features_.insert(features_.end(), last_features_.begin(), last_features_.end());
  }
  const auto duration_ns =
      static_cast<float>(std::max<std::int64_t>(scan.end_ns - scan.start_ns, 1));
  const float per_ns = 1.0F / duration_ns;
  for (Feature& f : features_)
    f.s = scan.motion_compensated ? 1.0F : std::clamp(f.s * per_ns, 0.0F, 1.0F);
  return features_;
}

int FeatureImage::column_of(float azimuth_rad) const {
  const auto column =
      static_cast<int>((std::numbers::pi_v<float> - azimuth_rad) * columns_per_rad(columns_));
  return std::clamp(column < columns_ ? column : column - columns_, 0, columns_ - 1);
}

bool FeatureImage::is_used(const Return& r) const {
  const float range2 = r.x_m * r.x_m + r.y_m * r.y_m + r.z_m * r.z_m;
  return range2 >= nearest2_ && range2 <= farthest2_ && r.ring < beams_.ring_count;  // not NaN
}

void FeatureImage::project(std::span<const Return> returns) {
  if (first_column_ < 0) {
    const auto first =
        std::find_if(returns.begin(), returns.end(), [this](auto& r) { return is_used(r); });
    if (first == returns.end()) return;
    first_column_ = (column_of(first->azimuth_rad) + margin_) % columns_;
  }
  const int first_column = first_column_, classified = classified_;
  const int seam = columns_ - 2 * margin_;
  Pixel* pixels = pixels_.data();
  const auto spare = static_cast<std::ptrdiff_t>(pixels_.size()) - 1;
  int front = front_;
  bool disturbed = disturbed_;
  for (const Return& r : returns) {
    if (!is_used(r)) continue;
    const int column = column_of(r.azimuth_rad);
    const std::uint64_t bit = std::uint64_t{1} << (r.ring % 64U);
    std::uint64_t& filled = filled_[static_cast<std::size_t>(column)][r.ring / 64U];
    const bool is_first = (filled & bit) == 0;
    filled |= bit;
    // Every other return comes second: a branch would be mispredicted as often.
    const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(column) * beams_.ring_count + r.ring;
    pixels[is_first ? pixel : spare] = {r.x_m, r.y_m, r.z_m, r.t_ns};
    const int past = column - first_column;
    const int place = past < 0 ? past + columns_ : past;
    disturbed |= is_first && place < classified;
    if (place < seam && place > front) front = place;
  }
  front_ = front;
  disturbed_ = disturbed;
}

void FeatureImage::classify_until(int place) {
  for (; classified_ < place; ++classified_) {
    const int column = first_column_ + classified_;
    if (column < columns_) {
      classify_column(column, last_features_);
    } else {
      classify_column(column - columns_, features_);
    }
  }
}

// From the pixel of each ring to that of the next: without branches, for several rings at a time.
FeatureImage::Steps FeatureImage::steps_of(const Pixel* pixels, const Filled& filled) const {
  const auto rows = static_cast<std::size_t>(beams_.ring_count);
  std::array<float, kMaxRings> flat_m, z_m;
  std::array<std::int32_t, kMaxRings> is_filled;
  for (std::size_t k = 0; k < rows; ++k) {
    is_filled[k] = static_cast<std::int32_t>((filled[k / 64] >> (k % 64)) & 1U);
    flat_m[k] = std::sqrt(pixels[k].x_m * pixels[k].x_m + pixels[k].y_m * pixels[k].y_m);
    z_m[k] = pixels[k].z_m;
  }
  Steps steps;
  for (std::size_t k = 0; k + 1 < rows; ++k) {
    const float dd = flat_m[k + 1] - flat_m[k];
    const float dz = z_m[k + 1] - z_m[k];
    const bool steep = std::abs(dz) > kSteep * std::abs(dd);
    // Rings are range * gap apart across the ray, and farther on what the ray grazes.
    const float gap = gap_rad_[k];
    const float slope = std::abs(z_m[k]) / flat_m[k];
    const float across_m = flat_m[k] * gap;
    const float along_m = across_m / (slope > gap ? slope : gap);
    const float reach_m = kSameSurface * (steep ? across_m : along_m);
    const std::int32_t step = steep ? kSteepStep : kFlatStep;
    const std::int32_t connected = dd * dd + dz * dz < reach_m * reach_m ? step : 0;
    steps[k] = (is_filled[k] & is_filled[k + 1]) != 0 ? connected : 0;
  }
  if (rows > 0) steps[rows - 1] = 0;
  return steps;
}

void FeatureImage::classify_column(int column, std::vector<Feature>& out) const {
  const int rows = beams_.ring_count;
  const Pixel* pixels = pixels_.data() + static_cast<std::ptrdiff_t>(column) * rows;
  const Filled& filled = filled_[static_cast<std::size_t>(column)];
  const Steps above = steps_of(pixels, filled);
  std::array<std::int32_t, kMaxRings> rings;
  std::size_t count = 0;
  std::int32_t below = 0;
  for (int ring = 0; ring < rows; ++ring) {
    const auto k = static_cast<std::size_t>(ring);
    const std::int32_t around = above[k] | below;
    below = above[k];
    const bool is_filled = ((filled[k / 64] >> (k % 64)) & 1U) != 0;
    const bool foot = around == (kFlatStep | kSteepStep);  // a kerb or the foot of a wall: neither
    const bool roof = around == kFlatStep && pixels[ring].z_m >= 0.0F;  // or canopy, from below
    rings[count] = ring;
    count += is_filled && !foot && !roof ? 1U : 0U;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(rings[i]);
    add_feature(pixels, rings[i], k > 0 ? above[k - 1] : 0, above[k], out);
  }
}

void FeatureImage::add_feature(const Pixel* column, int ring, std::int32_t below,
                               std::int32_t above, std::vector<Feature>& out) const {
  const Pixel& p = column[ring];
  Feature f{p.x_m,
            p.y_m,
            p.z_m,
            static_cast<float>(p.t_ns),  // until finish()
            0.0F,
            0.0F,
            0.0F,
            ((above | below) & kFlatStep) != 0 ? Kind::ground : Kind::structure,
            static_cast<std::uint8_t>(ring)};
  if ((above | below) != 0) {
    const Pixel& neighbour = above != 0 ? column[ring + 1] : column[ring - 1];
    f.dx_m = neighbour.x_m - p.x_m;
    f.dy_m = neighbour.y_m - p.y_m;
    f.dz_m = neighbour.z_m - p.z_m;
  } else {
    // Across the ray. Without it what is thin and level, a bridge far ahead or a rail, holds the
    // ring that sees it at the height at which it was seen first, and with it the pitch.
    const float flat_m = std::max(1e-3F, std::sqrt(p.x_m * p.x_m + p.y_m * p.y_m));
    const float up = gap_rad_[static_cast<std::size_t>(ring)];
    f.dx_m = -up * p.z_m * p.x_m / flat_m;
    f.dy_m = -up * p.z_m * p.y_m / flat_m;
    f.dz_m = up * flat_m;
  }
  out.push_back(f);
}

}  // namespace lilo::standard
