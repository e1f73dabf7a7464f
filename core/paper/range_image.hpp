// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry_config.hpp"
#include "core/scan.hpp"

#include <opencv2/core.hpp>

#include <cstdint>
#include <vector>

/// The spherical range image of the paper, Section 3.1.
namespace lilo::paper {

/// Where a pixel's value comes from: one return, or a point between the returns of two beams.
struct Pixel {
  std::int32_t first = -1;   ///< index into Scan::returns; -1: the pixel is empty
  std::int32_t second = -1;  ///< -1: the pixel is `first` itself
  float weight = 0.0F;       ///< of `second`, in (0, 1)
};

/// M x N image I of ranges (Eq. 3) and, beside it, the return behind every pixel, so that
/// reconstruction can give back the exact point instead of the pixel's centre.
/// Row 0 is the highest beam; column j looks along azimuth pi - 2 pi j / N (Eq. 16).
/// Eq. 3 prints r_(column, row); here (row, column), as OpenCV has it. The paper then normalises I
/// to grey levels; here it stays in metres, so that no threshold depends on the farthest return.
struct RangeImage {
  cv::Mat1f range_m;  ///< 0 where empty
  std::vector<Pixel> pixels;

  [[nodiscard]] int rows() const { return range_m.rows; }
  [[nodiscard]] int columns() const { return range_m.cols; }
  [[nodiscard]] const Pixel& at(int row, int column) const { return pixels[index_of(row, column)]; }
  [[nodiscard]] Pixel& at(int row, int column) { return pixels[index_of(row, column)]; }
  [[nodiscard]] std::size_t index_of(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(range_m.cols) +
           static_cast<std::size_t>(column);
  }
};

/// r of Eq. 2, the range of a return from the sensor's centre: the norm of the three coordinates of
/// Eq. 1, where the print takes that of their sum.
float range_of(const Return& r);

/// theta of Eq. 2 in the middle of column j, which is omega of Eq. 16: pi - 2 pi j / N, in (-pi,
/// pi].
double column_azimuth_rad(int column, int columns);

/// Eqs. 2-5: one row a beam, `columns` over the full turn.
/// - Eq. 2: theta is the azimuth of the beam from the driver, atan2(y, x); the print says y / z.
/// - Eq. 4: phi' counts beams, so i is the beam and Y_res is 1; asin(z / r) is not needed.
/// - Eq. 5: the print leaves direction and rounding open. The direction is Eq. 16's, clockwise from
///   behind; rounding is to the nearest column, as Eq. 18 has it.
/// The paper is silent on several returns in one pixel: the nearest wins, it hides the others.
/// Returns nearer than `min_range_m` or farther than `max_range_m` are left out.
void project(const Scan& scan, int columns, double min_range_m, double max_range_m,
             RangeImage& image);

/// Section 3.1, bilinear interpolation of a 16-beam image to `rows` rows (a multiple of its own).
/// Between rows only: the columns are dense already. The paper interpolates everywhere; across a
/// depth jump that invents points in free space, so here a row is filled only between two returns
/// whose ranges differ by less than 20 % of the nearer one.
void interpolate_rows(const RangeImage& image, int rows, RangeImage& taller);

/// The image of a scan as configured: projected, and interpolated where the sensor has fewer beams
/// than `interpolated_rows`.
RangeImage image_of(const Scan& scan, const OdometryConfig& config);

}  // namespace lilo::paper
