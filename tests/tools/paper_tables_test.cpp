// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/base64.hpp"
#include "tools/bench/paper/box.hpp"
#include "tools/bench/paper/html_report.hpp"
#include "tools/bench/paper/published.hpp"
#include "tools/bench/paper/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace lilo::paper_bench {
namespace {

/// Moore and McCabe's textbook way and R's quantile(type = 7) agree on these.
TEST(Box, QuartilesOfKnownSamples) {
  const Box five = box_of({9, 1, 5, 3, 7});
  EXPECT_EQ(five.q1, 3.0);
  EXPECT_EQ(five.median, 5.0);
  EXPECT_EQ(five.q3, 7.0);
  EXPECT_EQ(five.mean, 5.0);
  EXPECT_EQ(five.low, 1.0);
  EXPECT_EQ(five.high, 9.0);
  const Box four = box_of({1, 2, 3, 4});  // R: 1.75 2.5 3.25
  EXPECT_DOUBLE_EQ(four.q1, 1.75);
  EXPECT_DOUBLE_EQ(four.median, 2.5);
  EXPECT_DOUBLE_EQ(four.q3, 3.25);
}

TEST(Box, WhiskersEndAtTheLastSampleWithinOneAndAHalfBoxes) {
  const Box box = box_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 30});  // box 3.25 to 7.75, fence at 14.5
  EXPECT_EQ(box.high, 9.0);
  EXPECT_EQ(box.low, 1.0);
  EXPECT_EQ(box.outliers, std::vector<double>{30.0});
  const Box one = box_of({4});
  EXPECT_EQ(one.low, 4.0);
  EXPECT_EQ(one.high, 4.0);
  EXPECT_TRUE(one.outliers.empty());
}

TEST(Cells, AreTheGridAndOneChangeEach) {
  const auto hdl = cells_of("a", 64, false);
  EXPECT_EQ(hdl.size(), 14U);  // 9 + Fourier + one stage + no deskewing + centres + shadows
  const auto kitti = cells_of("a", 64, true);
  EXPECT_EQ(kitti.size(), 12U);
  const auto vlp = cells_of("a", 16, false);
  EXPECT_EQ(vlp.size(), 15U);  // and no interpolation
  for (const auto& cells : {hdl, kitti, vlp}) {
    std::set<std::string> stems;
    for (const Cell& cell : cells) stems.insert(file_stem(cell));
    EXPECT_EQ(stems.size(), cells.size());
    EXPECT_EQ(std::count(cells.begin(), cells.end(), chosen_cell("a", cells == vlp ? 16 : 64)), 1);
  }
  const OdometryConfig config = odometry_config(chosen_cell("a", 16), 16, {});
  EXPECT_EQ(config.profile, Profile::paper);
  EXPECT_EQ(config.paper.interpolated_rows, 32);
  EXPECT_EQ(config.paper.ground_filter, GroundFilter::fourier);
  EXPECT_EQ(odometry_config(chosen_cell("a", 64), 64, {}).paper.interpolated_rows, 0);
}

CellResult result_of(const Cell& cell, int beams, double t, double r, double ms) {
  CellResult result{.cell = cell, .beams = beams};
  result.path_m = 200.0;
  result.segment_lengths_m = "100-200";
  result.t_percent = t;
  result.r_deg_per_100m = r;
  result.ate_m = 0.5;
  result.total_ms = ms;
  result.true_x_m = 150.0;
  return result;
}

std::string at(const CsvTable& table, std::size_t row, const std::string& column) {
  return table.rows.at(row).at(table.column(column));
}

TEST(Table1, HasThePapersFiguresBesideOurs) {
  CellResult park = result_of(chosen_cell("park", 16), 16, 2.0, 8.0, 30.0);
  CellResult short_one = result_of(chosen_cell("short", 64), 64, kUnknown, kUnknown, 50.0);
  short_one.segment_lengths_m.clear();
  const CsvTable table =
      table_1({result_of(chosen_cell("07", 64), 64, 0.5, 0.3, 40.0), park, short_one});
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(at(table, 0, "t_percent"), "0.50");
  EXPECT_EQ(at(table, 0, "paper_t_percent"), "0.60");  // Table 1, row 07: 0.60/0.61
  EXPECT_EQ(at(table, 0, "paper_r_deg_per_100m"), "0.61");
  EXPECT_EQ(at(table, 0, "segments"), "100-200 m");
  EXPECT_EQ(at(table, 1, "image"), "32x720");
  EXPECT_EQ(at(table, 1, "paper_t_percent"), "");
  EXPECT_EQ(at(table, 2, "segments"), "too short for the metric");
  EXPECT_EQ(at(table, 2, "t_percent"), "");
  EXPECT_EQ(at(table, 3, "set"), "mean");
  EXPECT_EQ(at(table, 3, "t_percent"), "1.25");  // of 0.5 and 2.0
  EXPECT_EQ(at(table, 3, "time_ms"), "40.0");
}

TEST(Table1, TakesOnlyTheChosenCell) {
  Cell other = chosen_cell("07", 64);
  other.columns = 360;
  EXPECT_TRUE(table_1({result_of(other, 64, 1.0, 1.0, 1.0)}).rows.empty());
}

TEST(Published, IsThePapersTable1) {
  // The means of the printed column: 0.86 and 0.36.
  double t = 0.0, r = 0.0;
  for (const char* name : {"00", "01", "02", "03", "04", "05", "06", "07", "08", "09", "10"}) {
    t += published_sequence(name)->t_percent / 11.0;
    r += published_sequence(name)->r_deg_per_100m / 11.0;
  }
  EXPECT_NEAR(t, kPublishedMeanT_percent, 0.005);
  EXPECT_NEAR(r, kPublishedMeanR_deg_per_100m, 0.005);
  EXPECT_EQ(published_sequence("kitti_04")->path_m, 397.0);
  EXPECT_EQ(published_sequence("2011_09_30_drive_0027_sync")->path_m, 695.0);
  EXPECT_FALSE(published_sequence("sim_vlp16_park").has_value());
}

TEST(Table3, IsOfLoopsOnly) {
  CellResult loop = result_of(chosen_cell("loop", 16), 16, 1.0, 1.0, 25.0);
  loop.true_x_m = 1.0, loop.true_y_m = 0.0;
  loop.end_x_m = 4.0, loop.end_y_m = 4.0, loop.end_z_m = 0.0;  // off by 3, 4, 0
  const CsvTable table = table_3({loop, result_of(chosen_cell("road", 16), 16, 1.0, 1.0, 25.0)});
  ASSERT_EQ(table.rows.size(), 3U);  // the loop, the mean, the paper's
  EXPECT_EQ(at(table, 0, "loop"), "loop");
  EXPECT_EQ(at(table, 0, "x_m"), "3.00");
  EXPECT_EQ(at(table, 0, "d_m"), "5.00");
  EXPECT_EQ(at(table, 1, "d_m"), "5.00");
  EXPECT_EQ(at(table, 2, "d_m"), "0.83");
  EXPECT_TRUE(table_3({}).rows.empty());
}

TEST(Boxes, GoOverTheSetsWithAsManyRows) {
  Results results;
  for (const double t : {1.0, 2.0, 3.0}) {
    results.push_back(
        result_of(chosen_cell("set" + std::to_string(t), 64), 64, t, t / 10.0, 10.0 * t));
  }
  results.push_back(result_of(chosen_cell("vlp", 16), 16, 9.0, 9.0, 9.0));
  Cell rigid = chosen_cell("set", 64);
  rigid.deskew = Deskew::none;  // not part of the grid
  results.push_back(result_of(rigid, 64, 100.0, 100.0, 100.0));
  const CsvTable table = boxes(results);
  ASSERT_EQ(table.rows.size(), 6U);  // one place of the grid, three measures, two heights
  const auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const auto& r) {
    return r[table.column("rows")] == "64" && r[table.column("measure")] == "t_percent";
  });
  ASSERT_NE(row, table.rows.end());
  EXPECT_EQ((*row)[table.column("x")], "6");  // 360: 1-3, 720: EG 4, ES 5, EGS 6
  EXPECT_EQ((*row)[table.column("label")], "64x720 EGS");
  EXPECT_EQ((*row)[table.column("sets")], "3");
  EXPECT_EQ((*row)[table.column("q1")], "1.5");
  EXPECT_EQ((*row)[table.column("median")], "2");
  EXPECT_EQ(box_samples(results).rows.size(), 12U);
}

TEST(Choices, SayWhatWasChanged) {
  Cell cell = chosen_cell("vlp", 16);
  cell.deskew = Deskew::none;
  cell.rows = 16;
  const CsvTable table = table_of_choices(
      {result_of(chosen_cell("vlp", 16), 16, 1, 1, 1), result_of(cell, 16, 1, 1, 1)});
  EXPECT_EQ(at(table, 0, "change"), "the paper's choice");
  EXPECT_EQ(at(table, 1, "change"), "no interpolation, no deskewing");
}

TEST(Base64, Rfc4648Vectors) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(HtmlReport, NeedsNothingElse) {
  const CsvTable table{{"set", "t_percent", "paper_t_percent"}, {{"a<b", "1.0", "2.0"}}};
  const std::string html = html_report("/", "words", {{"T", "note", "t.csv", table}}, {});
  EXPECT_NE(html.find("a&lt;b"), std::string::npos);
  EXPECT_NE(html.find("<th class=paper>paper t %</th>"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find("src=\""), std::string::npos);
}

}  // namespace
}  // namespace lilo::paper_bench
