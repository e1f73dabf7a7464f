#include "core/standard/feature_image.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace lilo::standard {
namespace {

// Ground seen from a tilted sensor or on a hill stays below this slope, walls and trunks above.
constexpr float kSteep = 0.84F;  // tan 40 degrees
// Two returns belong to one surface when they are not much farther apart than the rings would be
// on a surface of that slope.
constexpr float kSameSurface = 3.0F;
// Rings that meet the ground farther apart say little of how it runs between: believed to be
// straight from one to the other it bent the map of every fast drive. From 8 to 15 m the errors
// hardly change.
constexpr float kFarApart_m = 10.0F;
// The lasers of one firing look up to 18 degrees apart (HDL-64E). Columns nearer to the front, and
// those around the scan's first return, where it ends as well, may still get returns.
constexpr float kSpread_rad = 0.35F;
// With 64 rings, 512 to 1024 columns give the same errors. Fewer are worse, more cost time.
constexpr int kMostPixels = 64 * 576;

template <typename Bits>
bool has(const Bits& bits, std::size_t ring) {
  return (bits[ring / 64] >> (ring % 64) & 1U) != 0;
}

float columns_per_rad(int columns) {
  return static_cast<float>(columns) / (2.0F * std::numbers::pi_v<float>);
}

/// Of an image `columns` wide that begins straight behind and goes clockwise.
std::uint32_t column_of(float azimuth_rad, int columns, float per_rad) {
  const auto column = static_cast<int>((std::numbers::pi_v<float> - azimuth_rad) * per_rad);
  const int turned = column < columns ? column : column - columns;
  return static_cast<std::uint32_t>(std::clamp(turned, 0, columns - 1));
}

}  // namespace

FeatureImage::FeatureImage(int columns, RangeLimits limits)
    : most_columns_(columns),
      nearest2_(static_cast<float>(limits.min_m * limits.min_m)),
      farthest2_(static_cast<float>(limits.max_m * limits.max_m)) {}

int FeatureImage::columns_for(int rings, int most) {
  return std::min(most, kMostPixels / std::max(rings, 1));
}

const std::vector<Feature>& FeatureImage::build(const Scan& scan) {
  begin(scan.beams);
  project(scan.returns);
  return finish(scan);
}

void FeatureImage::begin(const BeamTable& beams) {
  beams_ = beams;
  columns_ = columns_for(beams.ring_count, most_columns_);
  margin_ = static_cast<int>(std::ceil(kSpread_rad * columns_per_rad(columns_)));
  const auto size = static_cast<std::size_t>(beams.ring_count) * static_cast<std::size_t>(columns_);
  pixels_.resize(size);
  steps_.fill({});
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

int FeatureImage::place_of(int column) const {
  const int place = column - first_column_;
  return place < 0 ? place + columns_ : place;
}

void FeatureImage::project(std::span<const Return> returns) {
  // In registers, whatever is written to the image.
  const auto rows = static_cast<std::uint32_t>(beams_.ring_count);
  const int columns = columns_;
  const float per_rad = columns_per_rad(columns_);
  const float nearest2 = nearest2_, farthest2 = farthest2_;
  Pixel* const pixels = pixels_.data();
  Filled* const filled = filled_.data();
  for (const Return& r : returns) {
    const std::uint32_t ring = r.ring;
    if (ring >= rows) continue;
    const std::uint32_t column = column_of(r.azimuth_rad, columns, per_rad);
    const std::uint64_t bit = std::uint64_t{1} << (ring % 64U);
    std::uint64_t& word = filled[column][ring / 64U];
    if ((word & bit) != 0) continue;  // most
    const float range2 = r.x_m * r.x_m + r.y_m * r.y_m + r.z_m * r.z_m;
    if (!(range2 >= nearest2 && range2 <= farthest2)) continue;  // and NaN
    word |= bit;
    pixels[column * rows + ring] = {r.x_m, r.y_m, r.z_m, r.t_ns};
    note(static_cast<int>(column));
  }
}

/// A return fell into an empty pixel of the column.
void FeatureImage::note(int column) {
  if (first_column_ < 0) first_column_ = (column + margin_) % columns_;
  const int place = place_of(column);
  if (place <= classified_ && classified_ > 0) disturbed_ = true;  // or looked at from beside
  if (place < columns_ - 2 * margin_ && place > front_) front_ = place;
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

void FeatureImage::gather(int column, Gathered& g) const {
  const auto rows = static_cast<std::size_t>(beams_.ring_count);
  const auto pixels_of = [&](int c) { return pixels_.data() + static_cast<std::size_t>(c) * rows; };
  const auto flat_m = [](const Pixel& p) { return std::sqrt(p.x_m * p.x_m + p.y_m * p.y_m); };
  std::copy_n(pixels_of(column), rows, g.pixels.begin());
  g.own = filled_[static_cast<std::size_t>(column)];
  for (std::size_t k = 0; k < rows; ++k) {
    g.flats_m[k] = has(g.own, k) ? flat_m(g.pixels[k]) : 0.0F;
  }
  Filled have = g.own;
  const int place = place_of(column);
  for (const int side : {place > 0 ? -1 : 0, place + 1 < columns_ ? 1 : 0}) {
    const int other = (column + side + columns_) % columns_;
    for (std::size_t word = 0; word < have.size(); ++word) {
      std::uint64_t missing = filled_[static_cast<std::size_t>(other)][word] & ~have[word];
      have[word] |= missing;
      for (; missing != 0; missing &= missing - 1) {
        const std::size_t k = word * 64 + static_cast<std::size_t>(std::countr_zero(missing));
        const Pixel& stand_in = pixels_of(other)[k];
        if (stand_in.z_m >= 0.0F) continue;
        g.pixels[k] = stand_in;
        g.flats_m[k] = flat_m(stand_in);
      }
    }
  }
}

FeatureImage::Step FeatureImage::step_between(const Pixel* lower, const float* flats_m,
                                              float gap_rad) {
  const float dd = flats_m[1] - flats_m[0];
  const float dz = lower[1].z_m - lower[0].z_m;
  const bool steep = std::abs(dz) > kSteep * std::abs(dd);
  // Rings are range * gap apart across the ray, and farther on what the ray grazes: by the ratio of
  // flat to z, but not beyond the range.
  const float across_m = flats_m[0] * gap_rad;
  const float grazing_m = steep ? flats_m[0] : std::max(std::abs(lower->z_m), across_m);
  const float reach_m2 = kSameSurface * across_m * flats_m[0];
  const float length2_m2 = dd * dd + dz * dz;
  if (!(length2_m2 * grazing_m * grazing_m < reach_m2 * reach_m2)) return {};
  return {length2_m2, !steep, steep};
}

void FeatureImage::classify_column(int column, std::vector<Feature>& out) {
  const int rows = beams_.ring_count;
  Gathered gathered;
  gather(column, gathered);
  const Pixel* pixels = gathered.pixels.data();
  const float* flats_m = gathered.flats_m.data();
  Step* const step_to = steps_.data() + 1;  // from the ring below; to the lowest none
  for (int ring = 0; ring + 1 < rows; ++ring) {
    step_to[ring + 1] = flats_m[ring] > 0.0F && flats_m[ring + 1] > 0.0F
                            ? step_between(pixels + ring, flats_m + ring, gap_rad(ring))
                            : Step{};
  }
  for (int ring = 0; ring < rows; ++ring) {
    if (has(gathered.own, static_cast<std::size_t>(ring))) {
      add_feature(pixels, ring, step_to + ring, out);
    }
  }
}

float FeatureImage::gap_rad(int ring) const {
  if (beams_.ring_count < 2) return 0.0F;
  const auto lower = static_cast<std::size_t>(std::min(ring, beams_.ring_count - 2));
  return beams_.elevation_rad[lower + 1] - beams_.elevation_rad[lower];
}

void FeatureImage::add_feature(const Pixel* column, int ring, const Step* steps,
                               std::vector<Feature>& out) const {
  const Step before = steps[-1], below = steps[0], above = steps[1], beyond = steps[2];
  const Pixel& p = column[ring];
  const bool flat = above.flat || below.flat;
  const bool steep = above.steep || below.steep;
  if (flat && steep) return;          // a kerb or the foot of a wall: neither
  if (flat && p.z_m >= 0.0F) return;  // a roof or a canopy seen from below
  Feature f{p.x_m,
            p.y_m,
            p.z_m,
            static_cast<float>(p.t_ns),  // until finish()
            0.0F,
            0.0F,
            0.0F,
            flat ? Kind::ground : Kind::structure,
            static_cast<std::uint8_t>(ring)};
  // From the ground to the foot of a wall goes no surface.
  const Step to_lower = flat && before.steep ? Step{} : below;
  const Step to_upper = flat && beyond.steep ? Step{} : above;
  set_reach(column + ring, to_lower, to_upper, f);
  out.push_back(f);
}

void FeatureImage::set_reach(const Pixel* pixel, Step to_lower, Step to_upper, Feature& f) const {
  const bool up = to_upper.length2_m2 < to_lower.length2_m2;
  if ((up ? to_upper : to_lower).length2_m2 < kFarApart_m * kFarApart_m) {
    const Pixel& neighbour = up ? pixel[1] : pixel[-1];
    f.dx_m = neighbour.x_m - f.x_m;
    f.dy_m = neighbour.y_m - f.y_m;
    f.dz_m = neighbour.z_m - f.z_m;
    return;
  }
  // Across the ray. Without it what is thin and level, a bridge far ahead or a rail, holds the ring
  // that sees it at the height at which it was seen first, and with it the pitch.
  const float flat_m = std::max(1e-3F, std::sqrt(f.x_m * f.x_m + f.y_m * f.y_m));
  const float gap = gap_rad(f.ring);
  f.dx_m = -gap * f.z_m * f.x_m / flat_m;
  f.dy_m = -gap * f.z_m * f.y_m / flat_m;
  f.dz_m = gap * flat_m;
}

}  // namespace lilo::standard
