// SPDX-License-Identifier: BSD-3-Clause
#include "tools/gnuplot.hpp"

#include "tests/tools/temporary_folder.hpp"
#include "tools/plot/error_chart.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace lilo {
namespace {

bool has_gnuplot() { return std::system("gnuplot --version >/dev/null 2>&1") == 0; }

TEST(Gnuplot, DrawsThePictureAndKeepsTheScript) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const TemporaryFolder folder;
  folder.write("data.csv", "x,y\n0,1\n1,3\n");
  run_gnuplot(folder.path(), "line",
              gnuplot_head("line.png", 320, 200) + "plot 'data.csv' using 'x':'y' with lines\n");
  std::ifstream png(folder.path() + "/line.png", std::ios::binary);
  std::string signature(8, ' ');
  png.read(signature.data(), 8);
  EXPECT_EQ(signature, "\x89PNG\r\n\x1a\n");
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/line.gp"));
}

TEST(Gnuplot, AScriptItDoesNotLikeIsOneLineOfError) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const TemporaryFolder folder;
  try {
    run_gnuplot(folder.path(), "bad", "plot nothing_of_that_name\n");
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("bad.gp"), std::string::npos);
    EXPECT_NE(words.find("nothing_of_that_name"), std::string::npos);
    EXPECT_EQ(words.find('\n'), std::string::npos);
  }
}

TEST(Gnuplot, TextIsSingleQuotedSoThatNothingInItIsExecuted) {
  EXPECT_EQ(gnuplot_text("a \"b\" \\ `c` $d"), "'a \"b\" \\ `c` $d'");
  EXPECT_EQ(gnuplot_text("it's"), "'it''s'");
  EXPECT_EQ(gnuplot_text("two\nlines"), "'two lines'");
  EXPECT_EQ(gnuplot_file("<touch x"), "'./<touch x'");
}

// Whatever files and trajectories are called, no command of theirs runs, and the chart is drawn.
TEST(Gnuplot, NamesAndTitlesAreNeverCode) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::string name = "`touch ran_1` \"$(touch ran_2)\" it's $HOME \\ @x\n$y {Bold z}_^";
  Trajectory estimate{.name = name}, truth{.name = name};
  for (int k = 0; k < 20; ++k) {
    truth.poses.push_back({0, {.translation_m = {1.0 * k, 0, 0}}});
    estimate.poses.push_back({0, {.translation_m = {1.01 * k, 0, 0}}});
  }
  for (const std::string& stem : {name, "<touch ran_3;" + name, "|touch ran_4;" + name}) {
    const TemporaryFolder folder;
    const std::string out = folder.path() + "/" + stem + ".png";
    draw_errors({estimate, estimate}, truth, name, out);
    EXPECT_GT(std::filesystem::file_size(out), 1000U);
    EXPECT_TRUE(std::filesystem::exists(folder.path() + "/" + stem + "_1.csv"));
    // The picture, two tables and the script.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4);
  }
}

}  // namespace
}  // namespace lilo
