// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/features_view.hpp"

#include "core/paper/features.hpp"
#include "core/paper/segmentation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr Color kBackground{255, 255, 255};
constexpr Color kNothing{236, 238, 241};  // an empty pixel, or one of another part
constexpr Color kText{24, 28, 34};
constexpr Color kQuietText{104, 112, 122};
constexpr Color kFrame{205, 210, 216};
constexpr Color kEdge{214, 39, 40}, kSurface{31, 90, 190}, kGround{34, 150, 60};

constexpr int kWidth = 1600, kSide = 32, kGap = 24, kHeader = 72, kLabel = 30;
constexpr int kPanelWidth = (kWidth - 2 * kSide - kGap) / 2;
constexpr int kAboveHeight = 720;

/// Near is dark: as printed ranges are.
const std::vector<Color>& range_colors() {
  static const std::vector<Color> colors = {{38, 20, 60},   {60, 60, 140},  {30, 120, 160},
                                            {50, 170, 130}, {150, 205, 70}, {245, 210, 60}};
  return colors;
}

/// A part of the image: its name, its colour, which pixels are in it.
struct Part {
  const char* name;
  Color color;
  bool whole;  // the image itself, coloured by range
  paper::Label label = paper::Label::empty;
};

constexpr std::array<Part, 4> kParts = {{{"range image", kText, true},
                                         {"edges", kEdge, false, paper::Label::edge},
                                         {"surfaces", kSurface, false, paper::Label::surface},
                                         {"ground", kGround, false, paper::Label::ground}}};

struct Segmented {
  paper::RangeImage image;
  cv::Mat1b labels;
};

/// As the odometry does it: Section 3 of the paper.
Segmented segmented(const Scan& scan, const OdometryConfig& config) {
  Segmented result{.image = paper::image_of(scan, config)};
  result.labels = paper::segment(result.image.range_m, config.paper, scan.beams);
  return result;
}

cv::Vec3b bgr(const Color& color) {
  return {static_cast<unsigned char>(color.b), static_cast<unsigned char>(color.g),
          static_cast<unsigned char>(color.r)};
}

/// Ranges that bound the image's colours: all but the nearest and farthest hundredth.
std::pair<double, double> range_bounds_m(const cv::Mat1f& range_m) {
  std::vector<float> ranges;
  std::copy_if(range_m.begin(), range_m.end(), std::back_inserter(ranges),
               [](float r) { return r > 0.0F; });
  if (ranges.empty()) return {1.0, 2.0};
  std::sort(ranges.begin(), ranges.end());
  const auto near_m = static_cast<double>(ranges[ranges.size() / 100]);
  const auto far_m = static_cast<double>(ranges[ranges.size() - 1 - ranges.size() / 100]);
  return {near_m, std::max(far_m, 1.1 * near_m)};
}

/// Part of the image in its final size; darker is nearer within a part.
cv::Mat picture_of(const Segmented& scan, const Part& part, int row_height) {
  const cv::Mat1f& range_m = scan.image.range_m;
  const auto [near_m, far_m] = range_bounds_m(range_m);
  cv::Mat3b picture(range_m.rows * row_height, kPanelWidth, bgr(kNothing));
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < kPanelWidth; ++x) {
      const int row = y / row_height, column = x * range_m.cols / kPanelWidth;
      const auto label = static_cast<paper::Label>(scan.labels(row, column));
      if (label == paper::Label::empty || (!part.whole && label != part.label)) continue;
      const double s =
          std::log(static_cast<double>(range_m(row, column)) / near_m) / std::log(far_m / near_m);
      picture(y, x) = bgr(
          part.whole ? along(range_colors(), s)
                     : mix(mix(part.color, {0, 0, 0}, 0.25), mix(part.color, kNothing, 0.45), s));
    }
  }
  return picture;
}

int pixels_of(const Segmented& scan, const Part& part) {
  return part.whole ? cv::countNonZero(scan.image.range_m > 0.0)
                    : cv::countNonZero(scan.labels == static_cast<int>(part.label));
}

void draw_images(Canvas& canvas, const Segmented& scan, int row_height) {
  const int height = scan.image.rows() * row_height;
  for (std::size_t k = 0; k < kParts.size(); ++k) {
    const Part& part = kParts.at(k);
    const int x = kSide + static_cast<int>(k % 2) * (kPanelWidth + kGap);
    const int y = kHeader + static_cast<int>(k / 2) * (height + kLabel + 12) + kLabel;
    canvas.text(fmt::format("{}, {} pixels", part.name, pixels_of(scan, part)), {1.0 * x, y - 9.0},
                11.0, part.color);
    canvas.paste(picture_of(scan, part, row_height), x, y);
  }
}

/// One of the two views in 3-D.
struct View {
  const char* name;
  double elevation_rad;
  int left, top;
  double reach_m;

  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d at = seen_from_above(p, elevation_rad) * (kPanelWidth / 2.0 / reach_m);
    return {left + kPanelWidth / 2.0 + at.x(), top + kAboveHeight / 2.0 - at.y()};
  }
  [[nodiscard]] bool shows(const Eigen::Vector2d& at) const {
    return at.x() > left + 2 && at.y() > top + 2 && at.x() < left + kPanelWidth - 2 &&
           at.y() < top + kAboveHeight - 2;
  }
};

void draw_cloud(Canvas& canvas, const View& view, const paper::Cloud& cloud, const Color& color,
                double radius) {
  for (const paper::Point& point : cloud) {
    const Eigen::Vector2d at = view(point.getVector3fMap().cast<double>());
    if (view.shows(at)) canvas.disc(at, radius, color);
  }
}

void draw_view(Canvas& canvas, const View& view, const paper::Features& features) {
  canvas.text(view.name, {1.0 * view.left, view.top - 9.0}, 11.0, kQuietText);
  draw_cloud(canvas, view, *features.ground, kGround, 0.8);
  draw_cloud(canvas, view, *features.surfaces, kSurface, 0.9);
  draw_cloud(canvas, view, *features.edges, kEdge, 1.3);
  const Eigen::Vector2d origin = view({0.0, 0.0, 0.0});
  canvas.disc(origin, 6.0, kBackground);
  canvas.circle(origin, 5.0, kText, 2.0);
  const double right = view.left + kPanelWidth, bottom = view.top + kAboveHeight;
  canvas.polyline({{1.0 * view.left, 1.0 * view.top},
                   {right, 1.0 * view.top},
                   {right, bottom},
                   {1.0 * view.left, bottom}},
                  kFrame, 1.0, true);
}

/// Most features are nearer.
double reach_of(const paper::Features& features) {
  std::vector<float> ranges;
  for (const auto* cloud : {&features.edges, &features.surfaces, &features.ground}) {
    for (const paper::Point& p : **cloud) ranges.push_back(std::hypot(p.x, p.y));
  }
  if (ranges.empty()) return 10.0;
  const auto k = static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(ranges.size() - 1));
  std::nth_element(ranges.begin(), ranges.begin() + k, ranges.end());
  return std::max(5.0, 1.15 * static_cast<double>(ranges[static_cast<std::size_t>(k)]));
}

void draw_legend(Canvas& canvas) {
  double x = kWidth - kSide;
  for (std::size_t k = kParts.size(); k-- > 1;) {
    const Part& part = kParts.at(k);
    canvas.text(part.name, {x, 42.0}, 12.0, kText, Align::right);
    x -= Canvas::text_width(part.name, 12.0) + 14.0;
    canvas.disc({x, 37.0}, 6.0, part.color);
    x -= 30.0;
  }
}

}  // namespace

Eigen::Vector2d seen_from_above(const Eigen::Vector3d& p, double elevation_rad) {
  return {-p.y(), p.x() * std::sin(elevation_rad) + p.z() * std::cos(elevation_rad)};
}

Canvas draw_features(const Scan& scan, const OdometryConfig& config, const std::string& title) {
  const Segmented parts = segmented(scan, config);
  const int row_height = parts.image.rows() <= 16 ? 9 : parts.image.rows() <= 32 ? 5 : 3;
  const int images = 2 * (parts.image.rows() * row_height + kLabel + 12);
  const int top = kHeader + images + kLabel + 8;
  Canvas canvas(kWidth, top + kAboveHeight + kSide, kBackground);
  canvas.text(title, {1.0 * kSide, 42.0}, 15.0, kText, Align::left, true);
  draw_legend(canvas);
  draw_images(canvas, parts, row_height);

  const paper::Features features =
      paper::reconstruct(scan, parts.image, parts.labels, config.paper.pixel_centres);
  const double reach_m = reach_of(features);
  draw_view(canvas, {"from above, x up", std::numbers::pi / 2.0, kSide, top, reach_m}, features);
  draw_view(canvas,
            {"from above behind, 30 degrees down", std::numbers::pi / 6.0,
             kSide + kPanelWidth + kGap, top, reach_m},
            features);
  return canvas;
}

}  // namespace lilo
