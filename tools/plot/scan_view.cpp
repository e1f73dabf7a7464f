// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/scan_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr Color kBackground{14, 18, 26};
constexpr Color kEmpty{24, 30, 41};
constexpr Color kText{232, 236, 241};
constexpr Color kQuietText{150, 160, 174};
constexpr Color kRing{52, 62, 80};

constexpr int kWidth = 1600, kSide = 32, kGap = 24, kHeader = 84;
constexpr int kImageWidth = kWidth - 2 * kSide;
constexpr int kPanel = (kImageWidth - kGap) / 2;
constexpr double kPi = std::numbers::pi;

const std::vector<Color>& spectrum() {
  static const std::vector<Color> colors = {{72, 40, 120},  {50, 100, 200}, {30, 165, 190},
                                            {80, 200, 120}, {220, 220, 60}, {250, 150, 50},
                                            {220, 60, 50}};
  return colors;
}

Eigen::Vector3d position_of(const Return& r) {
  return Eigen::Vector3f(r.x_m, r.y_m, r.z_m).cast<double>();
}

double range_of(const Return& r) { return position_of(r).norm(); }

/// The range that `part` of all returns do not exceed, 10 m of an empty scan.
double range_quantile_m(const Scan& scan, double part) {
  std::vector<double> ranges;
  ranges.reserve(scan.returns.size());
  for (const Return& r : scan.returns) ranges.push_back(range_of(r));
  if (ranges.empty()) return 10.0;
  const auto k = static_cast<std::ptrdiff_t>(part * static_cast<double>(ranges.size() - 1));
  std::nth_element(ranges.begin(), ranges.begin() + k, ranges.end());
  return ranges[static_cast<std::size_t>(k)];
}

cv::Vec3b bgr(const Color& color) {
  return {static_cast<unsigned char>(color.b), static_cast<unsigned char>(color.g),
          static_cast<unsigned char>(color.r)};
}

/// Colours go with the logarithm of the range: near structure matters as much as far.
cv::Mat range_image(const Scan& scan, int row_height, double near_m, double far_m) {
  const int rows = std::max(1, scan.beams.ring_count);
  cv::Mat3b image(rows * row_height, kImageWidth, bgr(kEmpty));
  for (const Return& r : scan.returns) {
    const double across = (kPi - static_cast<double>(r.azimuth_rad)) /
                          (2.0 * kPi);  // counter-clockwise is to the left
    const int x = std::clamp(static_cast<int>(across * kImageWidth), 0, kImageWidth - 1);
    const int y = (rows - 1 - std::min<int>(r.ring, rows - 1)) * row_height;
    const double s = std::log(range_of(r) / near_m) / std::log(far_m / near_m);
    image(cv::Rect(x, y, 1, row_height - 1)).setTo(bgr(along(spectrum(), s)));
  }
  return image;
}

/// Distance between range rings: 1, 2 or 5 times a power of ten, three to seven of them.
double ring_step_m(double reach_m) {
  const double decade = std::pow(10.0, std::floor(std::log10(reach_m)));
  const double lead = reach_m / decade;
  return decade * (lead > 5.0 ? 1.0 : lead > 2.0 ? 0.5 : 0.2);
}

struct Panel {
  Eigen::Vector2d centre;
  double reach_m;

  [[nodiscard]] double pixels_per_m() const { return kPanel / 2.0 / reach_m; }
  [[nodiscard]] Eigen::Vector2d operator()(double x_m, double y_m) const {
    return centre + Eigen::Vector2d(x_m, -y_m) * pixels_per_m();
  }
};

void draw_rings(Canvas& canvas, const Panel& panel) {
  const double step_m = ring_step_m(panel.reach_m);
  for (double r = step_m; r < panel.reach_m; r += step_m) {
    canvas.circle(panel.centre, r * panel.pixels_per_m(), kRing, 1.0);
    canvas.text(fmt::format("{:g} m", r), panel(0.0, -r) + Eigen::Vector2d(4.0, -5.0), 9.0,
                kQuietText);
  }
}

template <typename ColorOf>
void draw_from_above(Canvas& canvas, const Scan& scan, const Panel& panel, ColorOf&& color_of) {
  draw_rings(canvas, panel);
  for (const Return& r : scan.returns) {
    const Eigen::Vector3d p = position_of(r);
    const Eigen::Vector2d at = panel(p.x(), p.y());
    const Eigen::Vector2d off = (at - panel.centre).cwiseAbs();
    if (off.maxCoeff() < kPanel / 2.0 - 2.0) canvas.disc(at, 1.2, color_of(r));
  }
  canvas.polyline({panel.centre, panel.centre + Eigen::Vector2d(16.0, 0.0)}, {255, 80, 80}, 2.0);
  canvas.polyline({panel.centre, panel.centre - Eigen::Vector2d(0.0, 16.0)}, {80, 230, 110}, 2.0);
}

void draw_azimuths(Canvas& canvas, double y) {
  constexpr std::array kNames = {"180", "90 left", "0 ahead", "90 right", "180"};
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const Align align = k == 0                   ? Align::left
                        : k + 1 == kNames.size() ? Align::right
                                                 : Align::centre;
    const double x = kSide + kImageWidth * static_cast<double>(k) / (kNames.size() - 1.0);
    canvas.text(kNames.at(k), {x, y}, 9.0, kQuietText, align);
  }
}

}  // namespace

Canvas draw(const Scan& scan, const std::string& title) {
  const double near_m = std::max(0.3, range_quantile_m(scan, 0.01));
  const double far_m = std::max(2.0 * near_m, range_quantile_m(scan, 0.99));
  const int rings = std::max(1, scan.beams.ring_count);
  const int row_height = rings <= 32 ? 12 : 5;
  const int below_image = kHeader + rings * row_height;
  const int panel_top = below_image + 64;
  Canvas canvas(kWidth, panel_top + kPanel + kSide, kBackground);

  canvas.text(title, {1.0 * kSide, 38.0}, 17.0, kText, Align::left, true);
  canvas.text(fmt::format("range, {:.1f} m (violet) to {:.0f} m (red)", near_m, far_m),
              {1.0 * kSide, 70.0}, 11.0, kQuietText);
  canvas.paste(range_image(scan, row_height, near_m, far_m), kSide, kHeader);
  draw_azimuths(canvas, below_image + 18.0);

  const double reach_m = range_quantile_m(scan, 0.97) * 1.05;
  const double y = panel_top + kPanel / 2.0;
  const Panel left{{kSide + kPanel / 2.0, y}, reach_m};
  const Panel right{{kSide + kPanel * 1.5 + kGap, y}, reach_m};
  canvas.text("from above, by beam", {1.0 * kSide, panel_top - 10.0}, 11.0, kQuietText);
  canvas.text("from above, by intensity", {1.0 * kSide + kPanel + kGap, panel_top - 10.0}, 11.0,
              kQuietText);
  draw_from_above(canvas, scan, left, [&](const Return& r) {
    return along(spectrum(), 1.0 * r.ring / std::max(1, rings - 1));
  });
  draw_from_above(canvas, scan, right, [](const Return& r) {
    return along(spectrum(), std::sqrt(r.intensity / 255.0));
  });
  return canvas;
}

}  // namespace lilo
