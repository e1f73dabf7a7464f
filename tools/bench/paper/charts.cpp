// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/charts.hpp"

#include "tools/csv.hpp"
#include "tools/gnuplot.hpp"

#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace lilo::paper_bench {
namespace {

constexpr std::array kColors = {"#0072b2", "#d55e00", "#009e73"};  // Okabe and Ito

/// One panel of Figure 9a: boxes, means (circles) and outliers (crosses), as in the paper; with
/// few sets every one of them as a dot.
std::string box_panel(int rows, const char* measure, const char* axis, const char* color) {
  const std::string here =
      fmt::format("column('rows')=={} && strcol('measure') eq '{}'", rows, measure);
  return fmt::format(
      R"(set ylabel "{1}"
plot 'boxes.csv' using ({0} ? column('x') : NaN):'q1':'low':'high':'q3' with candlesticks whiskerbars 0.5 lc rgb "{2}" fs solid 0.25 border lc rgb "{2}" notitle, \
  'boxes.csv' using ({0} ? column('x') : NaN):'median':'median':'median':'median' with candlesticks lc rgb "{2}" lw 2.5 notitle, \
  'box_samples.csv' using ({0} && column('outlier')==0 ? column('x') : NaN):'value' with points pt 7 ps 0.5 lc rgb "#606060" notitle, \
  'box_samples.csv' using ({0} && column('outlier')==1 ? column('x') : NaN):'value' with points pt 1 ps 1.2 lw 1.5 lc rgb "#303030" notitle, \
  'boxes.csv' using ({0} ? column('x') : NaN):'mean' with points pt 6 ps 1.4 lw 2 lc rgb "black" notitle
)",
      here, axis, color);
}

std::string box_ticks(int rows) {
  std::string ticks;
  int x = 0;
  for (const int columns : {360, 720, 1024}) {
    for (const char* group : {"EG", "ES", "EGS"}) {
      ++x;
      ticks += fmt::format("{}\"{}\\n{}\" {}", x == 1 ? "" : ", ", group,
                           x % 3 == 2 ? fmt::format("{}x{}", rows, columns) : "", x);
    }
  }
  return "set xtics (" + ticks + ")\n";
}

struct BoxPanel {
  const char* measure;
  const char* axis;
  const char* color;
};

/// The panels of Figure 9a that have boxes: on short paths there are no errors.
std::vector<BoxPanel> box_panels(const std::string& folder, int rows) {
  const CsvTable boxes = read_csv(folder + "/boxes.csv");
  const std::size_t row_column = boxes.column("rows"), measure_column = boxes.column("measure");
  std::vector<BoxPanel> panels = {{"t_percent", "translation error (%)", "#c0392b"},
                                  {"r_deg_per_100m", "rotation error (deg / 100 m)", "#2e8b57"},
                                  {"total_ms", "CPU time (ms / scan)", "#2f5fb3"}};
  std::erase_if(panels, [&](const BoxPanel& panel) {
    return std::none_of(boxes.rows.begin(), boxes.rows.end(), [&](const auto& row) {
      return row[row_column] == std::to_string(rows) && row[measure_column] == panel.measure;
    });
  });
  return panels;
}

Chart box_chart(const std::string& folder, int rows, std::size_t sets) {
  const std::string name = fmt::format("fig9a_{}rows", rows);
  const std::vector<BoxPanel> panels = box_panels(folder, rows);
  const int count = static_cast<int>(panels.size());
  std::string script = gnuplot_head(name + ".png", 1200, 360 * count);
  script += box_ticks(rows) +
            fmt::format(
                "set xrange [0.4:9.6]\nset yrange [0:*]\nset boxwidth 0.55\nset lmargin 9\nset "
                "bmargin 3.2\n"
                "set arrow 1 from 3.5, graph 0 to 3.5, graph 1 nohead lc rgb '#999999'\n"
                "set arrow 2 from 6.5, graph 0 to 6.5, graph 1 nohead lc rgb '#999999'\n"
                "set multiplot layout {},1\n",
                count);
  for (const BoxPanel& panel : panels) {
    script += box_panel(rows, panel.measure, panel.axis, panel.color);
  }
  run_gnuplot(folder, name, script + "unset multiplot\n");
  return {
      name + ".png", fmt::format("Figure 9a, images of {} rows", rows),
      fmt::format("Image sizes and feature groups over {}: quartiles, whiskers to 1.5 box "
                  "heights; circle: mean, dot: a set, cross: an outlier. Drawn from the lines of "
                  "boxes.csv and box_samples.csv whose column rows is {}; paths too short for the "
                  "metric have times only.",
                  sets == 1 ? "the one set of this height" : "the sets of this height", rows)};
}

/// One line a file into a panel.
struct Line {
  std::string file, title;
};

std::string panel(const std::vector<Line>& lines, const std::string& x, const std::string& y,
                  const std::string& axis) {
  std::string text = fmt::format("set ylabel {}\nplot ", gnuplot_text(axis));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    text += fmt::format("{}{} using '{}':'{}' with lines lw 1.4 lc rgb '{}' title {}",
                        k == 0 ? "" : ", \\\n  ", gnuplot_file(lines[k].file), x, y,
                        kColors.at(k % 3), gnuplot_text(lines[k].title));
  }
  return text + "\n";
}

/// Two panels, one above the other, over the same x.
struct TwoPanels {
  std::string name, x, x_axis;
  std::array<std::string, 2> y, y_axis;
};

std::string two_panels(const std::string& folder, const TwoPanels& chart,
                       const std::vector<Line>& lines) {
  std::string script = gnuplot_head(chart.name + ".png", 1200, 760);
  script += "set yrange [0:*]\nset xrange [0:*]\nset lmargin 10\nset multiplot layout 2,1\n";
  script += panel(lines, chart.x, chart.y[0], chart.y_axis[0]);
  script += "unset key\nset xlabel " + gnuplot_text(chart.x_axis) + "\n";
  script += panel(lines, chart.x, chart.y[1], chart.y_axis[1]) + "unset multiplot\n";
  run_gnuplot(folder, chart.name, script);
  return chart.name + ".png";
}

std::vector<Line> lines_of(const std::vector<Cell>& cells, const char* kind, bool by_group) {
  std::vector<Line> lines;
  lines.reserve(cells.size());
  for (const Cell& cell : cells) {
    lines.push_back({fmt::format("{}/{}.csv", kind, file_stem(cell)),
                     by_group ? std::string(to_string(cell.group)) : image_text(cell)});
  }
  return lines;
}

/// "tracks/a.csv, tracks/b.csv".
std::string files_text(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) text += (text.empty() ? "" : ", ") + line.file;
  return text;
}

/// The chosen cell with every width, or with every group.
std::vector<Cell> row_of_grid(const Cell& chosen, bool by_group) {
  std::vector<Cell> cells(3, chosen);
  for (std::size_t k = 0; k < 3; ++k) {
    if (by_group) {
      cells[k].group = std::array{FeatureGroup::EG, FeatureGroup::ES, FeatureGroup::EGS}.at(k);
    } else {
      cells[k].columns = std::array{360, 720, 1024}.at(k);
    }
  }
  return cells;
}

/// What all paths and the truth take, with some air around.
struct Area {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e18), high = -low;

  void take(const CsvTable& track, const char* x_column, const char* y_column) {
    const std::size_t x = track.column(x_column), y = track.column(y_column);
    for (const std::vector<std::string>& row : track.rows) {
      const Eigen::Vector2d p(std::stod(row[x]), std::stod(row[y]));
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  /// One tenth more on every side, and neither side below a third of the other.
  [[nodiscard]] Area widened() const {
    const Eigen::Vector2d size = 1.2 * (high - low);
    const Eigen::Vector2d wide = size.cwiseMax(size.maxCoeff() / 3.0);
    const Eigen::Vector2d centre = 0.5 * (low + high);
    return {centre - 0.5 * wide, centre + 0.5 * wide};
  }
};

Area area_of(const std::string& folder, const std::vector<Line>& lines) {
  Area area;
  for (const Line& line : lines) {
    const CsvTable track = read_csv(folder + "/" + line.file);
    area.take(track, "x_m", "y_m");
    area.take(track, "true_x_m", "true_y_m");
  }
  return area.widened();
}

Chart path_chart(const std::string& folder, const Cell& chosen) {
  const std::vector<Line> lines = lines_of(row_of_grid(chosen, true), "tracks", true);
  const std::string name = "fig10_" + chosen.set;
  const Area area = area_of(folder, lines);
  const Eigen::Vector2d size = area.high - area.low;
  constexpr int kWidth = 1100, kAround = 110;  // pixels of the chart, and of its margins
  const int height = kAround + static_cast<int>(std::min(1.0, size.y() / size.x()) * kWidth);
  std::string script = gnuplot_head(name + ".png", kWidth, height);
  script += fmt::format(
      "set size ratio -1\nset grid xtics ytics\nset xrange [{:.3f}:{:.3f}]\n"
      "set yrange [{:.3f}:{:.3f}]\nset xlabel 'x (m)'\nset ylabel 'y (m)'\n",
      area.low.x(), area.high.x(), area.low.y(), area.high.y());
  script += fmt::format(
      "plot {} using 'true_x_m':'true_y_m' with lines lw 9 lc rgb '#d4d4d4' "
      "title 'truth'",
      gnuplot_file(lines[0].file));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    // Each on top of the one before and thinner, so that paths that agree are all seen.
    script += fmt::format(", \\\n  {} using 'x_m':'y_m' with lines lw {} lc rgb '{}' title {}",
                          gnuplot_file(lines[k].file), std::array{4.0, 2.6, 1.2}.at(k),
                          kColors.at(k), gnuplot_text(lines[k].title));
  }
  run_gnuplot(folder, name, script + "\n");
  return {name + ".png", "Figures 9b and 10, " + chosen.set,
          fmt::format("Paths by feature group, {} image, over the truth, laid over its first pose. "
                      "Drawn from {}, columns x_m, y_m, true_x_m, true_y_m.",
                      image_text(chosen), files_text(lines))};
}

void add_set_charts(const std::string& folder, const Cell& chosen, std::vector<Chart>& charts) {
  const std::vector<Line> tracks = lines_of(row_of_grid(chosen, true), "tracks", true);
  const std::vector<Line> scans = lines_of(row_of_grid(chosen, false), "scans", false);
  charts.push_back(path_chart(folder, chosen));
  charts.push_back({two_panels(folder,
                               {"errors_" + chosen.set,
                                "distance_m",
                                "true distance travelled (m)",
                                {"error_m", "error_deg"},
                                {"position error (m)", "orientation error (deg)"}},
                               tracks),
                    "Errors over distance, " + chosen.set,
                    fmt::format("Drift since the first pose, by feature group. Drawn from {}, "
                                "columns distance_m, error_m, error_deg.",
                                files_text(tracks))});
  charts.push_back(
      {two_panels(
           folder,
           {"fig11_" + chosen.set, "scan", "scan", {"edges", "surfaces"}, {"edges", "surfaces"}},
           scans),
       "Figure 11, " + chosen.set,
       fmt::format(
           "Features aligned in every scan, by image size; group {}. Drawn from {}, columns "
           "edges, surfaces.",
           to_string(chosen.group), files_text(scans))});
  charts.push_back({two_panels(folder,
                               {"fig12_" + chosen.set,
                                "scan",
                                "scan",
                                {"extraction_ms", "pose_ms"},
                                {"feature extraction (ms)", "pose and map (ms)"}},
                               scans),
                    "Figure 12, " + chosen.set,
                    fmt::format("CPU time of every scan, by image size; group {}. Drawn from {}, "
                                "columns extraction_ms, pose_ms.",
                                to_string(chosen.group), files_text(scans))});
}

}  // namespace

std::vector<Chart> draw_charts(const std::string& folder, const std::vector<CellResult>& results) {
  std::vector<Chart> charts;
  std::vector<Cell> chosen;
  for (const CellResult& result : results) {
    const Cell cell = chosen_cell(result.cell.set, result.beams);
    if (cell == result.cell) chosen.push_back(cell);
  }
  std::set<int> heights;
  for (const Cell& cell : chosen) heights.insert(cell.rows);
  for (const int rows : heights) {
    const auto sets = std::count_if(chosen.begin(), chosen.end(),
                                    [rows](const Cell& cell) { return cell.rows == rows; });
    charts.push_back(box_chart(folder, rows, static_cast<std::size_t>(sets)));
  }
  for (const Cell& cell : chosen) add_set_charts(folder, cell, charts);
  return charts;
}

}  // namespace lilo::paper_bench
