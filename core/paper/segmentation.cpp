// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/segmentation.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lilo::paper {
namespace {

/// 3x3 filter on a cylinder: one column of the other end on each side, top and bottom replicated.
cv::Mat1f filter_cylinder(const cv::Mat1f& image, const cv::Mat1f& kernel) {
  cv::Mat1f padded;
  cv::copyMakeBorder(image, padded, 0, 0, 1, 1, cv::BORDER_WRAP);
  cv::Mat1f response;
  cv::filter2D(padded, response, CV_32F, kernel, cv::Point(-1, -1), 0.0, cv::BORDER_REPLICATE);
  return cv::Mat1f(cv::abs(response(cv::Rect(1, 0, image.cols, image.rows))));
}

void fill_row_with_mean(cv::Mat1f& image, int row) {
  float sum = 0.0F;
  int filled = 0;
  for (int j = 0; j < image.cols; ++j) {
    if (image(row, j) <= 0.0F) continue;
    sum += image(row, j);
    ++filled;
  }
  const float mean = filled > 0 ? sum / static_cast<float>(filled) : 0.0F;
  for (int j = 0; j < image.cols; ++j) {
    if (image(row, j) <= 0.0F) image(row, j) = mean;
  }
}

/// Of the two sides of a depth jump only the nearer is a thing; the farther one is the shadow's
/// outline, which wanders over the background as the sensor moves.
cv::Mat1b nearer_side(const cv::Mat1f& range_m) {
  cv::Mat1b nearer(range_m.size());
  for (int i = 0; i < range_m.rows; ++i) {
    for (int j = 0; j < range_m.cols; ++j) {
      const auto seen = [&](int column) {
        const float r = range_m(i, (column + range_m.cols) % range_m.cols);
        return r > 0.0F ? r : std::numeric_limits<float>::max();
      };
      const float left = seen(j - 1), right = seen(j + 1);
      const float here = range_m(i, j);
      nearer(i, j) = std::max(left, right) - here > here - std::min(left, right) ? 255 : 0;
    }
  }
  return nearer;
}

}  // namespace

cv::Mat1f horizontal_sobel(const cv::Mat1f& range_m) {
  return filter_cylinder(range_m, (cv::Mat1f(3, 3) << -1, 0, 1, -2, 0, 2, -1, 0, 1));
}

cv::Mat1f vertical_sobel(const cv::Mat1f& range_m) {
  return filter_cylinder(range_m, (cv::Mat1f(3, 3) << -1, -2, -1, 0, 0, 0, 1, 2, 1));
}

cv::Mat1f fourier_filter(const cv::Mat1f& range_m) {
  cv::Mat1f filled = range_m.clone();
  for (int i = 0; i < filled.rows; ++i) fill_row_with_mean(filled, i);
  cv::Mat2f spectrum;
  cv::dft(filled, spectrum, cv::DFT_COMPLEX_OUTPUT);
  // Without the shift to the centre, Eq. 12's columns N/2-1 .. N/2+1 are N-1, 0 and 1.
  spectrum.colRange(0, 2).setTo(cv::Scalar::all(0.0));
  spectrum.col(spectrum.cols - 1).setTo(cv::Scalar::all(0.0));
  cv::Mat1f filtered;
  cv::dft(spectrum, filtered, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return filtered;
}

cv::Mat1b sobel_ground(const cv::Mat1f& range_m, double threshold_m) {
  cv::Mat1b mask(vertical_sobel(range_m) > threshold_m);
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3)));
  mask.setTo(0, range_m <= 0.0);
  return mask;
}

cv::Mat1b fourier_ground(const cv::Mat1f& range_m, int first_ground_row, double ratio) {
  const cv::Mat1f left(cv::abs(fourier_filter(range_m)));
  cv::Mat1b mask(left < ratio * range_m);
  mask.rowRange(0, std::clamp(first_ground_row, 0, mask.rows)).setTo(0);
  return mask;
}

int first_ground_row(const BeamTable& beams, int rows) {
  int above = 0;
  for (int ring = 0; ring < beams.ring_count; ++ring) {
    if (beams.elevation_rad[static_cast<std::size_t>(ring)] >= 0.0F) ++above;
  }
  return above * std::max(1, rows / std::max(1, beams.ring_count));
}

GroundFilter ground_filter_for(const PaperConfig& config, int beams) {
  constexpr int kFewBeams = 16;
  if (config.ground_filter != GroundFilter::by_sensor) return config.ground_filter;
  return beams <= kFewBeams ? GroundFilter::fourier : GroundFilter::sobel;
}

cv::Mat1b segment(const cv::Mat1f& range_m, const PaperConfig& config, const BeamTable& beams) {
  const int ground_row = first_ground_row(beams, range_m.rows);
  cv::Mat1b ground = ground_filter_for(config, beams.ring_count) == GroundFilter::sobel
                         ? sobel_ground(range_m, config.sobel_ground_m)
                         : fourier_ground(range_m, ground_row, config.fourier_ratio);
  ground.rowRange(0, std::clamp(ground_row, 0, ground.rows)).setTo(0);
  cv::Mat1b edge(horizontal_sobel(range_m) > config.sobel_edge_m);
  if (config.drop_shadow_edges) edge &= nearer_side(range_m);
  cv::Mat1b labels(range_m.size(), static_cast<uchar>(Label::surface));
  labels.setTo(static_cast<uchar>(Label::edge), edge);
  labels.setTo(static_cast<uchar>(Label::ground), ground);
  labels.setTo(static_cast<uchar>(Label::empty), range_m <= 0.0);
  return labels;
}

}  // namespace lilo::paper
