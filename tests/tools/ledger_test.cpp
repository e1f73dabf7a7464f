// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/ledger.hpp"

#include "tests/tools/temporary_folder.hpp"
#include "tools/bench/paper/cell_run.hpp"
#include "tools/csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace lilo::paper_bench {
namespace {

CellResult some_result(const std::string& set) {
  CellResult result{.cell = chosen_cell(set, 16), .beams = 16};
  result.cell.deskew = Deskew::one_stage;
  result.path_m = 82.7;
  result.ate_m = 0.125;
  result.end_z_m = -1.5;
  return result;
}

TEST(Ledger, KeepsEveryResult) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/cells.csv";
  {
    Ledger ledger(path);
    EXPECT_TRUE(ledger.results().empty());
    ledger.add(some_result("park, north"));
    ledger.add(some_result("town"));
  }
  const Ledger again(path);
  ASSERT_EQ(again.results().size(), 2U);
  const CellResult* park = again.find(some_result("park, north").cell);
  ASSERT_NE(park, nullptr);
  EXPECT_EQ(park->cell, some_result("park, north").cell);
  EXPECT_EQ(park->beams, 16);
  EXPECT_EQ(park->path_m, 82.7);
  EXPECT_EQ(park->end_z_m, -1.5);
  EXPECT_TRUE(std::isnan(park->t_percent));                 // unknown stays unknown
  EXPECT_EQ(again.find(chosen_cell("town", 16)), nullptr);  // with deskewing: another cell
}

TEST(Ledger, ARowThatWasCutOffIsDoneAgain) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/cells.csv";
  const std::string whole = csv_line(to_row(some_result("park")));
  folder.write("cells.csv", csv_line(result_columns()) + whole + whole.substr(0, whole.size() / 2));
  EXPECT_EQ(Ledger(path).results().size(), 1U);
}

TEST(Ledger, AForeignFileIsRefused) {
  const TemporaryFolder folder;
  folder.write("cells.csv", "time,x,y\n1,2,3\n");
  EXPECT_THROW(Ledger(folder.path() + "/cells.csv"), std::runtime_error);
  auto row = to_row(some_result("park"));
  row[5] = "EGX";
  folder.write("cells.csv", csv_line(result_columns()) + csv_line(row));
  EXPECT_THROW(Ledger(folder.path() + "/cells.csv"), std::runtime_error);
}

/// A pose every metre along x; the estimate's metres are 2 % too long.
Trajectory straight(double metre, int count) {
  Trajectory trajectory{.name = "straight", .has_times = true};
  for (int k = 0; k <= count; ++k) {
    trajectory.poses.push_back(
        {k * 100'000'000LL, {Eigen::Quaterniond::Identity(), {k * metre, 0, 0}}});
  }
  return trajectory;
}

TEST(CellErrors, AreThoseOfTheMetric) {
  CellResult result;
  add_errors(straight(1.02, 300), straight(1.0, 300), {}, result);
  EXPECT_EQ(result.segment_lengths_m, "100-200");
  // The devkit's segments are one step longer than their length: 101/100 and 201/200.
  EXPECT_NEAR(result.t_percent, 2.0, 0.03);
  EXPECT_NEAR(result.r_deg_per_100m, 0.0, 1e-9);
  EXPECT_NEAR(result.path_m, 300.0, 1e-9);
  EXPECT_NEAR(result.end_x_m - result.true_x_m, 6.0, 1e-9);
  EXPECT_FALSE(result.is_loop());
}

TEST(CellErrors, PathsTooShortForTheMetricSaySo) {
  CellResult result;
  add_errors(straight(1.02, 12), straight(1.0, 12), {}, result);
  EXPECT_TRUE(result.segment_lengths_m.empty());
  EXPECT_TRUE(std::isnan(result.t_percent));
  EXPECT_GT(result.ate_m, 0.0);
}

}  // namespace
}  // namespace lilo::paper_bench
