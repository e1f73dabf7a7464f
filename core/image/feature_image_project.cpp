// SPDX-License-Identifier: BSD-3-Clause
#include "core/image/feature_image.hpp"

#include <algorithm>
#include <numbers>
#include <tuple>

namespace lilo::core {

/// A copy of what tells where a return goes, in registers whatever is written to the image.
struct FeatureImage::Projector {
  Pixel* pixels;
  Filled* filled;
  std::uint32_t rows, columns;
  float per_rad, nearest2, farthest2;
  std::vector<Feature>* too_near;
  Filled* noted;
  Eigen::Matrix3f R_level_sensor;
  std::uint32_t reversed = R_level_sensor(2, 2) < 0.0F ? ~0U : 0U;  // all bits: upside down

  /// Of an upside-down sensor rows - 1 - ring. Not below `rows` if the ring is not.
  [[nodiscard]] std::uint32_t row_of(const Return& r) const {
    return (r.ring ^ reversed) + (rows & reversed);
  }
  /// Columns begin straight behind and go clockwise.
  [[nodiscard]] std::uint32_t column_of(const Return& r) const {
    const auto column = static_cast<std::uint32_t>(
        static_cast<std::int32_t>((std::numbers::pi_v<float> - r.azimuth_rad) * per_rad));
    return column < columns ? column : 0;  // at the seam rounding reaches the last column's end
  }
  /// Of any ring, without a branch.
  [[nodiscard]] std::size_t is_free(const Return& r, std::uint32_t column) const {
    const std::uint32_t row = row_of(r);
    const std::uint64_t word = filled[column][row / 64U % std::tuple_size_v<Filled>];
    return static_cast<std::size_t>(~word >> (row % 64U) & 1U);
  }
  void note_too_near(const Return& r, std::uint32_t row, std::uint32_t column) const {
    const std::uint64_t bit = std::uint64_t{1} << (row % 64U);
    std::uint64_t& word = noted[column][row / 64U];
    if ((word & bit) != 0) return;
    word |= bit;
    const Eigen::Vector3f p = R_level_sensor * Eigen::Vector3f(r.x_m, r.y_m, r.z_m);
    Feature f{};
    f.x_m = p.x();
    f.y_m = p.y();
    f.z_m = p.z();
    f.kind = FeatureKind::structure;
    f.ring = static_cast<std::uint8_t>(row);
    f.column = static_cast<std::uint16_t>(column);
    too_near->push_back(f);
  }
  /// False where the pixel is taken or the return out of range.
  bool put(const Return& r, std::uint32_t column) const {
    const std::uint32_t row = row_of(r);
    if (row >= rows) return false;
    const std::uint64_t bit = std::uint64_t{1} << (row % 64U);
    std::uint64_t& word = filled[column][row / 64U];
    if ((word & bit) != 0) return false;
    const float range2 = r.x_m * r.x_m + r.y_m * r.y_m + r.z_m * r.z_m;
    if (!(range2 >= nearest2 && range2 <= farthest2)) {  // and NaN
      if (range2 < nearest2) note_too_near(r, row, column);
      return false;
    }
    word |= bit;
    const Eigen::Vector3f p = R_level_sensor * Eigen::Vector3f(r.x_m, r.y_m, r.z_m);
    pixels[column * rows + row] = {p.x(), p.y(), p.z(), r.t_ns};
    return true;
  }
};

void FeatureImage::project(std::span<const Return> returns) {
  const Projector projector{pixels_.data(),
                            filled_.data(),
                            static_cast<std::uint32_t>(beams_.ring_count),
                            static_cast<std::uint32_t>(columns_),
                            columns_per_rad(columns_),
                            nearest2_,
                            farthest2_,
                            &too_near_,
                            noted_.data(),
                            R_level_sensor_};
  if (columns_ < most_columns_) {
    project_crowded(projector, returns);
    return;
  }
  for (const Return& r : returns) {
    const std::uint32_t column = projector.column_of(r);
    if (projector.put(r, column)) note(static_cast<int>(column));
  }
}

/// With more returns than pixels, a branch on a free pixel is hard to predict. So the returns whose
/// pixel is free are listed first, without a branch.
void FeatureImage::project_crowded(const Projector& projector, std::span<const Return> returns) {
  constexpr std::size_t kAtATime = 48;  // fewer than a firing has: hardly two are for one pixel
  std::array<std::uint32_t, kAtATime> at, columns;
  while (!returns.empty()) {
    const auto some = returns.first(std::min(returns.size(), kAtATime));
    returns = returns.subspan(some.size());
    std::size_t count = 0;
    for (std::size_t k = 0; k < some.size(); ++k) {
      const std::uint32_t column = projector.column_of(some[k]);
      at[count] = static_cast<std::uint32_t>(k);
      columns[count] = column;
      count += projector.is_free(some[k], column);
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (projector.put(some[at[k]], columns[k])) note(static_cast<int>(columns[k]));
    }
  }
}

/// A return fell into an empty pixel of the column.
void FeatureImage::note(int column) {
  if (sweep_.first_column < 0) sweep_.first_column = (column + margin_) % columns_;
  const int place = place_of(column);
  // The column itself was classified, or one beside it was, which used it.
  if (place < sweep_.classified + beside_ && sweep_.classified > 0) sweep_.invalidated = true;
  if (place < columns_ - 2 * margin_ && place > sweep_.front) sweep_.front = place;
}

int FeatureImage::place_of(int column) const {
  const int place = column - sweep_.first_column;
  return place < 0 ? place + columns_ : place;
}

}  // namespace lilo::core
