#include "tools/gnuplot.hpp"

#include "tests/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
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

TEST(Gnuplot, TextKeepsItsQuotes) { EXPECT_EQ(gnuplot_text("a \"b\" \\"), R"("a \"b\" \\")"); }

}  // namespace
}  // namespace lilo
