// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace lilo {

struct Color {
  int r = 0, g = 0, b = 0;
};

/// Colour `s` of the way from `a` to `b`; s is clamped to [0, 1].
Color mix(const Color& a, const Color& b, double s);

/// Colour at s in [0, 1] along evenly spaced stops.
Color along(const std::vector<Color>& stops, double s);

enum class Align : std::uint8_t { left, centre, right };

/// A picture to draw on in pixels, y down. Everything is drawn at twice the size and reduced when
/// saved, which is what makes OpenCV's lines and letters smooth.
class Canvas {
 public:
  Canvas(int width, int height, const Color& background);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// A BGR picture with its upper left corner at (x, y), one pixel a pixel.
  void paste(const cv::Mat& picture, int x, int y);
  void fill(const cv::Rect& area, const Color& color);
  void polyline(const std::vector<Eigen::Vector2d>& points, const Color& color, double width,
                bool closed = false);
  void disc(const Eigen::Vector2d& centre, double radius, const Color& color);
  void circle(const Eigen::Vector2d& centre, double radius, const Color& color, double width);
  /// `at` is on the baseline, at the side `align` names; `size` is the height of a capital letter.
  void text(const std::string& words, const Eigen::Vector2d& at, double size, const Color& color,
            Align align = Align::left, bool bold = false);
  static double text_width(const std::string& words, double size, bool bold = false);

  /// The picture in its final size.
  [[nodiscard]] cv::Mat image() const;
  /// PNG. Throws std::runtime_error.
  void save(const std::string& path) const;

 private:
  int width_, height_;
  cv::Mat large_;
};

}  // namespace lilo
