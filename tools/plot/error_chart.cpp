// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/error_chart.hpp"

#include "tools/eval/error_track.hpp"
#include "tools/gnuplot.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

namespace lilo {
namespace {

namespace fs = std::filesystem;

constexpr std::array kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7"};  // Okabe and Ito

std::string curves(const std::vector<Trajectory>& estimates, const std::string& stem,
                   const char* column) {
  std::string text = "plot ";
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    text +=
        fmt::format("{}{} using 'distance_m':'{}' with lines lw 1.8 lc rgb '{}' title {}",
                    k == 0 ? "" : ", \\\n  ", gnuplot_file(fmt::format("{}_{}.csv", stem, k + 1)),
                    column, kColors.at(k % kColors.size()), gnuplot_text(estimates[k].name));
  }
  return text + "\n";
}

}  // namespace

void draw_errors(const std::vector<Trajectory>& estimates, const Trajectory& truth,
                 const std::string& title, const std::string& out) {
  const fs::path path(out);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  const std::string stem = path.stem().string();
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    write_csv(fmt::format("{}/{}_{}.csv", folder, stem, k + 1),
              error_table(error_track(associate(estimates[k], truth))));
  }
  std::string script = gnuplot_head(path.filename().string(), 1200, 800);
  script += "set yrange [0:*]\nset xrange [0:*]\nset lmargin 10\nset multiplot layout 2,1 title " +
            gnuplot_text(title) + " noenhanced font ',15'\nset ylabel 'position error (m)'\n";
  script += curves(estimates, stem, "error_m");
  script +=
      "unset key\nset xlabel 'true distance travelled (m)'\n"
      "set ylabel 'orientation error (deg)'\n";
  run_gnuplot(folder, stem, script + curves(estimates, stem, "error_deg") + "unset multiplot\n");
}

}  // namespace lilo
