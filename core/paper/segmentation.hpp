#pragma once

#include "core/odometry_config.hpp"
#include "core/paper/range_image.hpp"

#include <opencv2/core.hpp>

#include <cstdint>

/// Image filtering of the paper, Section 3.2.
namespace lilo::paper {

/// The class of a pixel. Eqs. 8-10 are a partition: every filled pixel is in exactly one of the
/// last three.
enum class Label : std::uint8_t { empty, edge, surface, ground };

/// |M_E| of Eq. 6: response of the horizontal Sobel operator in metres (gain 8 on a ramp). The
/// image is a cylinder: column 0 follows column N-1. An empty pixel counts as range 0, so that an
/// object against the sky has edges.
cv::Mat1f horizontal_sobel(const cv::Mat1f& range_m);

/// |M_G| of Eq. 7: response of the vertical Sobel operator in metres.
cv::Mat1f vertical_sobel(const cv::Mat1f& range_m);

/// Eqs. 11-13: the image without the azimuthal frequencies -1, 0 and 1. Rows that are constant
/// along azimuth, or vary like a tilted plane, become zero. Empty pixels would tear the rows:
/// they take the mean of their row first.
cv::Mat1f fourier_filter(const cv::Mat1f& range_m);

/// Ground after Eq. 7: the thresholded response, closed morphologically, on filled pixels.
cv::Mat1b sobel_ground(const cv::Mat1f& range_m, double threshold_m);

/// Ground after Eqs. 11-13: rows whose beam looks below the horizon, where the filter leaves less
/// than `ratio` of the range.
cv::Mat1b fourier_ground(const cv::Mat1f& range_m, int first_ground_row, double ratio);

/// Eqs. 8-10: ground first, then edges outside it, surfaces are the rest. The print takes both
/// sides of a jump for edges; `drop_shadow_edges` leaves the farther one among the surfaces.
/// `first_ground_row`: the highest row that looks below the horizon. Shape as the image.
cv::Mat1b segment(const cv::Mat1f& range_m, const PaperConfig& config, int first_ground_row);

}  // namespace lilo::paper
