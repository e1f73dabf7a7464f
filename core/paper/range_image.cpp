// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/range_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::paper {
namespace {

void reset(RangeImage& image, int rows, int columns) {
  image.range_m.create(rows, columns);
  image.range_m.setTo(0.0);
  image.pixels.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), Pixel{});
}

/// Eq. 5 as the inverse of Eq. 16: the nearest column centre, wrapped.
int column_of(float azimuth_rad, int columns) {
  const float per_rad = static_cast<float>(columns) / (2.0F * std::numbers::pi_v<float>);
  const int j = static_cast<int>(std::lround((std::numbers::pi_v<float> - azimuth_rad) * per_rad));
  return ((j % columns) + columns) % columns;
}

}  // namespace

float range_of(const Return& r) { return std::sqrt(r.x_m * r.x_m + r.y_m * r.y_m + r.z_m * r.z_m); }

double column_azimuth_rad(int column, int columns) {
  return std::numbers::pi - 2.0 * std::numbers::pi * column / columns;
}

void project(const Scan& scan, int columns, double min_range_m, double max_range_m,
             RangeImage& image) {
  reset(image, std::max(1, scan.beams.ring_count), columns);  // OpenCV takes no empty image
  const auto nearest = static_cast<float>(min_range_m);
  const auto farthest = static_cast<float>(max_range_m);
  for (std::size_t k = 0; k < scan.returns.size(); ++k) {
    const Return& r = scan.returns[k];
    const float range_m = range_of(r);
    if (!(range_m >= nearest && range_m <= farthest)) continue;  // also drops NaN
    const int row = scan.beams.ring_count - 1 - r.ring;
    if (row < 0) continue;
    const int column = column_of(r.azimuth_rad, columns);
    float& pixel_range_m = image.range_m(row, column);
    if (pixel_range_m > 0.0F && pixel_range_m <= range_m) continue;
    pixel_range_m = range_m;
    image.at(row, column).first = static_cast<std::int32_t>(k);
  }
}

void interpolate_rows(const RangeImage& image, int rows, RangeImage& taller) {
  constexpr float kSameSurface = 0.2F;
  const int factor = std::max(1, rows / std::max(1, image.rows()));
  reset(taller, image.rows() * factor, image.columns());
  for (int row = 0; row < image.rows(); ++row) {
    for (int j = 0; j < image.columns(); ++j) {
      const float upper_m = image.range_m(row, j);
      if (upper_m <= 0.0F) continue;
      taller.range_m(row * factor, j) = upper_m;
      taller.at(row * factor, j) = image.at(row, j);
      if (row + 1 == image.rows()) continue;
      const float lower_m = image.range_m(row + 1, j);
      if (lower_m <= 0.0F) continue;
      if (std::abs(upper_m - lower_m) > kSameSurface * std::min(upper_m, lower_m)) continue;
      for (int s = 1; s < factor; ++s) {
        const float w = static_cast<float>(s) / static_cast<float>(factor);
        taller.range_m(row * factor + s, j) = (1.0F - w) * upper_m + w * lower_m;
        taller.at(row * factor + s, j) = {image.at(row, j).first, image.at(row + 1, j).first, w};
      }
    }
  }
}

RangeImage image_of(const Scan& scan, const OdometryConfig& config) {
  RangeImage image;
  project(scan, config.paper.columns, config.min_range_m, config.max_range_m, image);
  if (config.paper.interpolated_rows <= image.rows()) return image;
  RangeImage taller;
  interpolate_rows(image, config.paper.interpolated_rows, taller);
  return taller;
}

}  // namespace lilo::paper
