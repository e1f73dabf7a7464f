// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/canvas.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <png.h>
#include <stdexcept>

namespace lilo {
namespace {

constexpr int kScale = 2;
constexpr int kShift = 4;  // fractional bits of OpenCV's coordinates

constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr double kCapital = 21.0;  // height of a capital letter of this font at scale 1

cv::Scalar scalar(const Color& color) { return {1.0 * color.b, 1.0 * color.g, 1.0 * color.r}; }

cv::Point fixed(const Eigen::Vector2d& point) {
  constexpr double kUnit = kScale * (1 << kShift);
  return {static_cast<int>(std::lround(point.x() * kUnit)),
          static_cast<int>(std::lround(point.y() * kUnit))};
}

int thickness(double width) { return std::max(1, static_cast<int>(std::lround(width * kScale))); }

double font_scale(double size) { return size / kCapital; }
int stroke(double size, bool bold) {
  return std::max(1, static_cast<int>(std::lround(size * kScale * (bold ? 0.16 : 0.09))));
}

}  // namespace

Color mix(const Color& a, const Color& b, double s) {
  const double t = std::clamp(s, 0.0, 1.0);
  const auto channel = [t](int from, int to) {
    return static_cast<int>(std::lround(from + t * (to - from)));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

Color along(const std::vector<Color>& stops, double s) {
  const double at = std::clamp(s, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  return mix(stops[below], stops[below + 1], at - static_cast<double>(below));
}

Canvas::Canvas(int width, int height, const Color& background)
    : width_(width),
      height_(height),
      large_(height * kScale, width * kScale, CV_8UC3, scalar(background)) {}

void Canvas::paste(const cv::Mat& picture, int x, int y) {
  cv::Mat target =
      large_(cv::Rect(x * kScale, y * kScale, picture.cols * kScale, picture.rows * kScale));
  cv::resize(picture, target, target.size(), 0.0, 0.0, cv::INTER_NEAREST);
}

void Canvas::fill(const cv::Rect& area, const Color& color) {
  const cv::Rect large(area.x * kScale, area.y * kScale, area.width * kScale, area.height * kScale);
  cv::rectangle(large_, large, scalar(color), cv::FILLED);
}

void Canvas::polyline(const std::vector<Eigen::Vector2d>& points, const Color& color, double width,
                      bool closed) {
  std::vector<cv::Point> line;
  line.reserve(points.size());
  for (const Eigen::Vector2d& point : points) line.push_back(fixed(point));
  cv::polylines(large_, line, closed, scalar(color), thickness(width), cv::LINE_AA, kShift);
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius, const Color& color) {
  const int r = fixed({radius, 0.0}).x;
  cv::circle(large_, fixed(centre), r, scalar(color), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::circle(const Eigen::Vector2d& centre, double radius, const Color& color,
                    double width) {
  const int r = fixed({radius, 0.0}).x;
  cv::circle(large_, fixed(centre), r, scalar(color), thickness(width), cv::LINE_AA, kShift);
}

double Canvas::text_width(const std::string& words, double size, bool bold) {
  int below = 0;
  const double scale = font_scale(size) * kScale;
  return cv::getTextSize(words, kFont, scale, stroke(size, bold), &below).width / (1.0 * kScale);
}

void Canvas::text(const std::string& words, const Eigen::Vector2d& at, double size,
                  const Color& color, Align align, bool bold) {
  const double part = align == Align::left ? 0.0 : align == Align::centre ? 0.5 : 1.0;
  const double x = at.x() - part * text_width(words, size, bold);
  const cv::Point origin(static_cast<int>(std::lround(x * kScale)),
                         static_cast<int>(std::lround(at.y() * kScale)));
  cv::putText(large_, words, origin, kFont, font_scale(size) * kScale, scalar(color),
              stroke(size, bold), cv::LINE_AA);
}

cv::Mat Canvas::image() const {
  cv::Mat small;
  cv::resize(large_, small, cv::Size(width_, height_), 0.0, 0.0, cv::INTER_AREA);
  return small;
}

void Canvas::save(const std::string& path) const {
  const cv::Mat picture = image();
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(picture.cols);
  png.height = static_cast<png_uint_32>(picture.rows);
  png.format = PNG_FORMAT_BGR;
  const auto row_bytes = static_cast<png_int_32>(picture.step[0]);
  if (png_image_write_to_file(&png, path.c_str(), 0, picture.data, row_bytes, nullptr) == 0) {
    throw std::runtime_error(fmt::format("{}: cannot write: {}", path, png.message));
  }
}

}  // namespace lilo
