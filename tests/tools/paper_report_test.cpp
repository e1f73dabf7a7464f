// SPDX-License-Identifier: BSD-3-Clause
#include "tests/tools/temporary_folder.hpp"
#include "tools/bench/paper/paper_bench.hpp"
#include "tools/csv.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>

/// Every number of the page stands in a CSV file, where the page says it does.
namespace lilo::paper_bench {
namespace {

constexpr int kScans = 60;

/// A drive along x that turns back (`loop`) or not; the estimate is `scale` times as long.
Trajectory drive(bool loop, double scale) {
  Trajectory trajectory{.name = "drive", .has_times = true};
  for (int k = 0; k <= kScans; ++k) {
    const double x_m = loop ? 30.0 - std::abs(30.0 - k) : 1.0 * k;
    trajectory.poses.push_back(
        {k * 100'000'000LL, {Eigen::Quaterniond::Identity(), {scale * x_m, 0.01 * k, 0.0}}});
  }
  return trajectory;
}

void write_scans(const std::string& path) {
  CsvTable table{{"scan", "edges", "surfaces", "extraction_ms", "pose_ms"}, {}};
  for (int k = 0; k <= kScans; ++k) {
    table.rows.push_back({fmt::format("{}", k), "100", fmt::format("{}", 900 - k), "1.5", "9.25"});
  }
  write_csv(path, table);
}

/// Results that differ in every figure, with the files a bench leaves behind.
std::vector<CellResult> make_results(const BenchmarkSet& set, int beams,
                                     const std::string& folder) {
  std::vector<CellResult> results;
  for (const Cell& cell : cells_of(set.name, beams, false)) {
    const double n = static_cast<double>(results.size()) + 0.1 * beams;
    CellResult result{.cell = cell, .beams = beams};
    result.edges = 101.4 + n, result.surfaces = 907.7 + n;
    result.extraction_ms = 1.234 + n, result.pose_ms = 7.77 + n, result.total_ms = 9.004 + n;
    const Trajectory estimate = drive(set.name == "loop", 1.01 + 0.001 * n);
    add_errors(estimate, *set.truth, {20.0}, result);
    write_tum(folder + "/poses/" + file_stem(cell) + ".tum", estimate.poses);
    write_scans(folder + "/scans/" + file_stem(cell) + ".csv");
    results.push_back(result);
  }
  return results;
}

std::string text_of(const std::string& path) {
  std::ifstream file = open_text(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What lies between two marks, searched from `at`; moves `at` behind it. Empty at the end.
std::string between(const std::string& text, const std::string& from, const std::string& to,
                    std::size_t& at) {
  const std::size_t begin = text.find(from, at);
  if (begin == std::string::npos) return at = std::string::npos, "";
  const std::size_t end = text.find(to, begin + from.size());
  at = end + to.size();
  return text.substr(begin + from.size(), end - begin - from.size());
}

std::vector<std::string> lines_of(const std::string& path) {
  std::vector<std::string> lines;
  std::ifstream file = open_text(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

class PaperReport : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("gnuplot --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "gnuplot is not installed";
    }
    for (const char* inner : {"scans", "poses", "tracks"}) {
      std::filesystem::create_directories(folder_.path() + "/" + inner);
    }
  }

  /// The page, without its pictures.
  std::string report(const std::vector<BenchmarkSet>& sets) {
    std::vector<CellResult> results;
    for (const BenchmarkSet& set : sets) {
      const int beams = set.name == "road" ? 64 : 16;
      for (const CellResult& result : make_results(set, beams, folder_.path())) {
        results.push_back(result);
      }
    }
    testing::internal::CaptureStdout();
    write_report(sets, results, folder_.path());
    testing::internal::GetCapturedStdout();
    std::string html = text_of(folder_.path() + "/report.html");
    for (std::size_t at = 0; (at = html.find("data:image", at)) != std::string::npos;) {
      html.erase(at, html.find('"', at) - at);
    }
    return html;
  }

  TemporaryFolder folder_;
  const BenchmarkSet loop_{"loop", "loop", drive(true, 1.0)},
      road_{"road", "road", drive(false, 1.0)};
};

TEST_F(PaperReport, EveryCellOfATableIsInTheLineItNames) {
  const std::string html = report({loop_, road_});
  std::set<std::string> files;
  std::size_t at = 0, numbers = 0;
  while (at != std::string::npos) {
    const std::string section = between(html, "<h2>", "</table>", at);
    std::size_t in = 0;
    const std::string file = between(section, "The table is <code>", "</code>", in);
    if (file.empty()) continue;
    files.insert(file);
    const std::vector<std::string> lines = lines_of(folder_.path() + "/" + file);
    const std::string head = "<td class=line>";
    std::size_t rows = 0;
    for (std::size_t row = section.find(head); row != std::string::npos;
         row = section.find(head, row + 1), ++rows) {
      const std::size_t number = std::stoul(section.substr(row + head.size()));
      ASSERT_LE(number, lines.size()) << file;
      std::size_t cell = section.find("</td>", row) + 5;
      for (const std::string& field : csv_fields(lines[number - 1])) {
        EXPECT_EQ(between(section, ">", "</td>", cell), field) << file << ':' << number;
        ++numbers;
      }
    }
    EXPECT_EQ(rows + 1, lines.size()) << file;
  }
  EXPECT_EQ(files, (std::set<std::string>{"table1.csv", "table3.csv", "choices.csv", "boxes.csv",
                                          "summary.csv"}));
  EXPECT_GT(numbers, 500U);
}

TEST_F(PaperReport, EveryFigureNamesItsFilesAndColumns) {
  const std::string html = report({loop_, road_});
  std::size_t at = 0, figures = 0;
  while (true) {
    const std::string caption = between(html, "<figcaption>", "</figcaption>", at);
    if (at == std::string::npos) break;
    ++figures;
    const std::regex name("[A-Za-z0-9_/]+\\.csv");
    std::string columns;
    int files = 0;
    for (std::sregex_iterator it(caption.begin(), caption.end(), name), end; it != end; ++it) {
      const CsvTable table = read_csv(folder_.path() + "/" + it->str());
      EXPECT_FALSE(table.rows.empty()) << it->str();
      for (const std::string& column : table.columns) columns += " " + column + " ";
      ++files;
    }
    EXPECT_GE(files, 2) << caption;
    const std::size_t listed = caption.find("columns ");
    if (listed == std::string::npos) continue;
    const std::regex word("[a-z_]+");
    const std::string named = caption.substr(listed + 8);
    for (std::sregex_iterator it(named.begin(), named.end(), word), end; it != end; ++it) {
      EXPECT_NE(columns.find(" " + it->str() + " "), std::string::npos) << it->str();
    }
  }
  EXPECT_EQ(figures, 2U + 2U * 4U);  // 9a by height; paths, errors, 11 and 12 by set
}

TEST_F(PaperReport, ProseHoldsNoResults) {
  std::string prose = report({loop_, road_});
  for (const auto& [from, to] : {std::pair{"<style>", "</style>"}, {"<table>", "</table>"}}) {
    for (std::size_t at = 0; (at = prose.find(from)) != std::string::npos;) {
      prose.erase(at, prose.find(to, at) - at + std::string(to).size());
    }
  }
  prose = std::regex_replace(prose,
                             std::regex("<[^>]*>|[A-Za-z0-9_/]+\\.csv|[0-9]+x[0-9]+|Tables? [0-9]+|"
                                        "Figures? [0-9]+[ab]?( and [0-9]+)?"),
                             " ");
  // The fence of a box plot, what counts as a loop, KITTI 00 to 10, the paper's GHz, image heights.
  const std::set<std::string> definitions = {"1.5", "2", "00", "10", "2.6", "32", "64"};
  const std::regex number("[0-9]+(\\.[0-9]+)?");
  for (std::sregex_iterator it(prose.begin(), prose.end(), number), end; it != end; ++it) {
    EXPECT_TRUE(definitions.contains(it->str()))
        << it->prefix().str().substr(it->prefix().length() > 60
                                         ? static_cast<std::size_t>(it->prefix().length()) - 60
                                         : 0)
        << it->str();
  }
}

TEST_F(PaperReport, WithoutALoopItSaysSo) {
  EXPECT_NE(report({road_}).find("there is no loop to close"), std::string::npos);
  EXPECT_EQ(report({loop_}).find("there is no loop to close"), std::string::npos);
}

}  // namespace
}  // namespace lilo::paper_bench
