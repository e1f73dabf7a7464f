// SPDX-License-Identifier: BSD-3-Clause
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

/// |M_E| of Eq. 6: response of the horizontal Sobel operator in metres (gain 8 on a ramp). Its
/// sign, which says on which side is farther, is dropped. The print is silent on borders and holes:
/// the image is a cylinder, column 0 follows column N-1; top and bottom rows are repeated. An empty
/// pixel counts as range 0, so that an object against the sky has edges.
cv::Mat1f horizontal_sobel(const cv::Mat1f& range_m);

/// |M_G| of Eq. 7: response of the vertical Sobel operator in metres, as horizontal_sobel().
cv::Mat1f vertical_sobel(const cv::Mat1f& range_m);

/// I' of Eq. 13: the image without the azimuthal frequencies -1, 0 and 1.
/// - Eq. 11: the print's arrow points the other way.
/// - Eq. 12: its strict "<" leaves column N/2 only, frequency 0; the released program clears
///   N/2-1 ... N/2+1. So rows that vary like a tilted plane vanish as well as constant ones. What
///   the paper calls a low-pass filter removes low frequencies.
/// - Eq. 13: I' is what is left, the image without ground.
/// Empty pixels would tear the rows: they take the mean of their row first.
cv::Mat1f fourier_filter(const cv::Mat1f& range_m);

/// M_G of Eq. 9 by Eq. 7, binary: the response above a threshold, closed morphologically (3 x 3),
/// on filled pixels. The print multiplies the image by the response itself; then Eq. 10 would be no
/// partition.
cv::Mat1b sobel_ground(const cv::Mat1f& range_m, double threshold_m);

/// M_G of Eq. 9 by Eqs. 11-13, binary: pixels of rows from `first_ground_row` down, where the
/// filter leaves less than `ratio` of the range. The paper is silent on how much is left of ground.
cv::Mat1b fourier_ground(const cv::Mat1f& range_m, int first_ground_row, double ratio);

/// The highest row of an image of `rows` rows that looks below the horizon: those above can hold no
/// ground, which the paper does not say.
int first_ground_row(const BeamTable& beams, int rows);

/// Section 5: Fourier up to 16 beams and Sobel above, unless configured. An HDL-64E's beams do not
/// draw circles on the ground.
GroundFilter ground_filter_for(const PaperConfig& config, int beams);

/// Eqs. 8-10 as a label a pixel: ground first, then edges outside it (as the released program),
/// surfaces are the rest. The print takes both sides of a jump for edges; `drop_shadow_edges`
/// leaves the farther one among the surfaces. Shape as the image.
cv::Mat1b segment(const cv::Mat1f& range_m, const PaperConfig& config, const BeamTable& beams);

}  // namespace lilo::paper
