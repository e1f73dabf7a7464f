#include "daemon/metrics_writer.hpp"

#include "tests/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <sys/stat.h>
#include <thread>

namespace lilo {
namespace {

using namespace std::chrono_literals;

std::string read_whole(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(MetricsWriter, WritesWhatItWasGivenBeforeItEnds) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/metrics";
  { EXPECT_TRUE(MetricsWriter().write(path, "the last")); }
  EXPECT_EQ(read_whole(path), "the last");
}

TEST(MetricsWriter, WritesWhereItIsTold) {
  const TemporaryFolder folder;
  const std::string one = folder.path() + "/one", other = folder.path() + "/other";
  {
    MetricsWriter writer;
    writer.write(one, "first");
    while (read_whole(one) != "first") std::this_thread::sleep_for(1ms);
    while (!std::filesystem::exists(other)) {
      writer.write(other, "second");  // unless it is still at the first
      std::this_thread::sleep_for(1ms);
    }
  }
  EXPECT_EQ(read_whole(one), "first");
  EXPECT_EQ(read_whole(other), "second");
}

// A pipe that nobody reads holds whoever opens it, as a disk does that does not answer. A writer
// that waited would never come to the lines that read it.
TEST(MetricsWriter, WaitsForNoDisk) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/metrics", draft = path + ".new";
  ASSERT_EQ(mkfifo(draft.c_str(), 0600), 0);
  {
    MetricsWriter writer;
    EXPECT_TRUE(writer.write(path, "taken"));
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(writer.write(path, "left out"));
    EXPECT_EQ(read_whole(draft), "taken");
  }
  EXPECT_TRUE(std::filesystem::is_fifo(path)) << "it was put in the place of the file";
}

TEST(MetricsWriter, TellsThatItCannotWrite) {
  MetricsWriter writer;
  EXPECT_TRUE(writer.write("/nonexistent/lilo.prom", "x")) << "not known yet";
  while (writer.write("/nonexistent/lilo.prom", "x")) std::this_thread::sleep_for(1ms);
  SUCCEED();
}

TEST(MetricsWriter, WithoutAFileThereIsNoThread) {
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const auto before = threads();
  MetricsWriter writer;
  EXPECT_TRUE(writer.write("", "x"));
  EXPECT_EQ(threads(), before);
}

}  // namespace
}  // namespace lilo
