// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/density_image.hpp"

#include <algorithm>
#include <cmath>

namespace lilo {

std::pair<double, double> height_range_m(const std::vector<Dot>& dots) {
  if (dots.empty()) return {0.0, 1.0};
  std::vector<double> heights;
  heights.reserve(dots.size());
  for (const Dot& dot : dots) heights.push_back(dot.height_m);
  const auto at = [&](double part) {
    const auto k = static_cast<std::ptrdiff_t>(part * static_cast<double>(heights.size() - 1));
    std::nth_element(heights.begin(), heights.begin() + k, heights.end());
    return heights[static_cast<std::size_t>(k)];
  };
  const double low = at(0.01), high = at(0.99);
  return {low, std::max(high, low + 1.0)};
}

const std::vector<Color>& height_colors() {
  static const std::vector<Color> colors = {
      {58, 76, 104}, {52, 116, 148}, {70, 165, 160}, {150, 205, 140}, {240, 225, 130}};
  return colors;
}

cv::Mat density_image(int width, int height, const std::vector<Dot>& dots,
                      const Color& background) {
  cv::Mat1d count(height, width, 0.0);
  cv::Mat1d top(height, width, -1e9);
  for (const Dot& dot : dots) {
    const int x = static_cast<int>(std::floor(dot.x)), y = static_cast<int>(std::floor(dot.y));
    if (x < 0 || y < 0 || x >= width || y >= height) continue;
    count(y, x) += 1.0;
    top(y, x) = std::max(top(y, x), dot.height_m);
  }
  const auto [low_m, high_m] = height_range_m(dots);
  cv::Mat3b image(height, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Color full = along(height_colors(), (top(y, x) - low_m) / (high_m - low_m));
      const double opacity = count(y, x) > 0.0 ? 1.0 - 0.55 * std::exp(-count(y, x) / 4.0) : 0.0;
      const Color color = mix(background, full, opacity);
      image(y, x) = {static_cast<unsigned char>(color.b), static_cast<unsigned char>(color.g),
                     static_cast<unsigned char>(color.r)};
    }
  }
  return image;
}

}  // namespace lilo
