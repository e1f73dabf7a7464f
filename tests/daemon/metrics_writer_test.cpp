#include "daemon/metrics_writer.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace lilo {
namespace {

using namespace std::chrono_literals;

std::string read_whole(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A path of this process, with no file there.
std::string fresh_path(const char* name) {
  std::string path = testing::TempDir() + "lilo_" + name + "_" + std::to_string(getpid());
  std::filesystem::remove(path);
  return path;
}

TEST(MetricsWriter, WritesWhatItWasGivenBeforeItEnds) {
  const std::string path = fresh_path("last_metrics");
  { EXPECT_TRUE(MetricsWriter().write(ReplacedFile(path), "the last")); }
  EXPECT_EQ(read_whole(path), "the last");
  std::filesystem::remove(path);
}

TEST(MetricsWriter, WritesWhereItIsTold) {
  const std::string one = fresh_path("one_metrics"), other = fresh_path("other_metrics");
  {
    MetricsWriter writer;
    writer.write(ReplacedFile(one), "first");
    while (read_whole(one) != "first") std::this_thread::sleep_for(1ms);
    while (!std::filesystem::exists(other)) {
      writer.write(ReplacedFile(other), "second");  // unless it is still at the first
      std::this_thread::sleep_for(1ms);
    }
  }
  EXPECT_EQ(read_whole(one), "first");
  EXPECT_EQ(read_whole(other), "second");
  std::filesystem::remove(one);
  std::filesystem::remove(other);
}

// A pipe that nobody reads holds whoever opens it, as a disk does that does not answer. A writer
// that waited would never come to the lines that read it.
TEST(MetricsWriter, WaitsForNoDisk) {
  const std::string path = fresh_path("slow_metrics"), draft = path + ".new";
  ASSERT_EQ(mkfifo(draft.c_str(), 0600), 0);
  {
    MetricsWriter writer;
    EXPECT_TRUE(writer.write(ReplacedFile(path), "taken"));
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(writer.write(ReplacedFile(path), "left out"));
    EXPECT_EQ(read_whole(draft), "taken");
  }
  EXPECT_TRUE(std::filesystem::is_fifo(path)) << "it was put in the place of the file";
  std::filesystem::remove(path);
}

TEST(MetricsWriter, TellsThatItCannotWrite) {
  MetricsWriter writer;
  EXPECT_TRUE(writer.write(ReplacedFile("/nonexistent/lilo.prom"), "x")) << "not known yet";
  while (writer.write(ReplacedFile("/nonexistent/lilo.prom"), "x"))
    std::this_thread::sleep_for(1ms);
  SUCCEED();
}

TEST(MetricsWriter, WithoutAFileThereIsNoThread) {
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const auto before = threads();
  MetricsWriter writer;
  EXPECT_TRUE(writer.write(ReplacedFile(""), "x"));
  EXPECT_EQ(threads(), before);
}

}  // namespace
}  // namespace lilo
