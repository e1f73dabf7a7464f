// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/plot/canvas.hpp"

#include <utility>
#include <vector>

namespace lilo {

/// A dot to be drawn: where, in pixels, and how high, in metres.
struct Dot {
  double x, y, height_m;
};

/// Heights that bound all but the lowest and the highest hundredth; {0, 1} of no dots.
std::pair<double, double> height_range_m(const std::vector<Dot>& dots);

/// Colours of the heights, lowest first.
const std::vector<Color>& height_colors();

/// Dots coloured by height; where many fall on a pixel it is more opaque, and the highest of them
/// gives the colour, so that walls and trees stand out of the ground.
cv::Mat density_image(int width, int height, const std::vector<Dot>& dots, const Color& background);

}  // namespace lilo
