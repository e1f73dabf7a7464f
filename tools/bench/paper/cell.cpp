// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/cell.hpp"

#include <fmt/format.h>

namespace lilo::paper_bench {

const char* to_string(FeatureGroup group) {
  switch (group) {
    case FeatureGroup::EG:
      return "EG";
    case FeatureGroup::ES:
      return "ES";
    case FeatureGroup::EGS:
      return "EGS";
  }
  return "unknown";
}

const char* to_string(GroundFilter filter) {
  switch (filter) {
    case GroundFilter::by_sensor:
      return "by_sensor";
    case GroundFilter::sobel:
      return "sobel";
    case GroundFilter::fourier:
      return "fourier";
  }
  return "unknown";
}

const char* to_string(Deskew deskew) {
  switch (deskew) {
    case Deskew::none:
      return "none";
    case Deskew::one_stage:
      return "one_stage";
    case Deskew::two_stage:
      return "two_stage";
  }
  return "unknown";
}

std::string image_text(const Cell& cell) { return fmt::format("{}x{}", cell.rows, cell.columns); }

std::string file_stem(const Cell& cell) {
  std::string stem = fmt::format("{}_{}_{}_{}", cell.set, image_text(cell), to_string(cell.group),
                                 to_string(cell.ground_filter));
  if (cell.deskew == Deskew::none) stem += "_rigid";
  if (cell.deskew == Deskew::one_stage) stem += "_one_stage";
  if (cell.pixel_centres) stem += "_centres";
  if (!cell.drop_shadow_edges) stem += "_shadows";
  return stem;
}

Cell chosen_cell(const std::string& set, int beams) {
  Cell cell{.set = set, .rows = beams};
  if (beams <= 16) {
    cell.rows = 2 * beams;
    cell.ground_filter = GroundFilter::fourier;
    cell.group = FeatureGroup::ES;
  }
  return cell;
}

std::vector<Cell> cells_of(const std::string& set, int beams, bool deskewed) {
  const Cell chosen = chosen_cell(set, beams);
  std::vector<Cell> cells;
  for (const int columns : {360, 720, 1024}) {
    for (const FeatureGroup group : {FeatureGroup::EG, FeatureGroup::ES, FeatureGroup::EGS}) {
      cells.push_back(chosen);
      cells.back().columns = columns;
      cells.back().group = group;
    }
  }
  const auto change = [&](auto&& how) {
    cells.push_back(chosen);
    how(cells.back());
  };
  change([](Cell& cell) {
    const bool sobel = cell.ground_filter == GroundFilter::sobel;
    cell.ground_filter = sobel ? GroundFilter::fourier : GroundFilter::sobel;
  });
  if (chosen.rows != beams) change([beams](Cell& cell) { cell.rows = beams; });
  if (!deskewed) {
    change([](Cell& cell) { cell.deskew = Deskew::one_stage; });
    change([](Cell& cell) { cell.deskew = Deskew::none; });
  }
  change([](Cell& cell) { cell.pixel_centres = true; });
  change([](Cell& cell) { cell.drop_shadow_edges = false; });
  return cells;
}

OdometryConfig odometry_config(const Cell& cell, int beams, const OdometryConfig& base) {
  OdometryConfig config = base;
  config.profile = Profile::paper;
  config.paper.columns = cell.columns;
  config.paper.interpolated_rows = cell.rows > beams ? cell.rows : 0;
  config.paper.ground_filter = cell.ground_filter;
  config.paper.group = cell.group;
  config.paper.deskew = cell.deskew;
  config.paper.pixel_centres = cell.pixel_centres;
  config.paper.drop_shadow_edges = cell.drop_shadow_edges;
  return config;
}

}  // namespace lilo::paper_bench
