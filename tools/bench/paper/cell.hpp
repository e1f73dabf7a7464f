// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry_config.hpp"

#include <string>
#include <vector>

/// `lilo bench paper`: the experiments of the LiLO paper, Section 5.
namespace lilo::paper_bench {

/// One experiment: a set taken through profile `paper` with one choice of everything.
struct Cell {
  std::string set;
  int rows = 64;  ///< image height; beyond the number of beams, rows are interpolated
  int columns = 720;
  GroundFilter ground_filter = GroundFilter::sobel;
  FeatureGroup group = FeatureGroup::EGS;
  Deskew deskew = Deskew::two_stage;
  bool pixel_centres = false;     ///< true: points in the middle of their pixel, as printed
  bool drop_shadow_edges = true;  ///< false: both sides of a jump are edges, as printed

  bool operator==(const Cell&) const = default;
};

const char* to_string(FeatureGroup group);
const char* to_string(GroundFilter filter);
const char* to_string(Deskew deskew);

/// "64x720".
std::string image_text(const Cell& cell);

/// For file names: "set_64x720_EGS_sobel", and what else differs from the odometry's defaults.
std::string file_stem(const Cell& cell);

/// What the paper settled for: HDL-64E 64x720, Sobel, EGS (Section 5.1); VLP-16 32x720
/// interpolated, Fourier, ES (Section 5.2).
Cell chosen_cell(const std::string& set, int beams);

/// The grid of Figure 9a around the chosen cell, 3 widths x 3 groups, then the chosen cell with one
/// choice changed: the other ground filter, no interpolation (where there is one), deskewing in one
/// stage and not at all (where the recording is not `deskewed` already), and two readings of this
/// program taken back to the print: pixel centres, shadow edges.
std::vector<Cell> cells_of(const std::string& set, int beams, bool deskewed);

/// The odometry of a cell; what the cell says nothing about is taken from `base`.
OdometryConfig odometry_config(const Cell& cell, int beams, const OdometryConfig& base);

}  // namespace lilo::paper_bench
