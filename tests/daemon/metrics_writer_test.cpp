// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/metrics_writer.hpp"

#include "tests/daemon/text_of.hpp"
#include "tests/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <string>
#include <sys/stat.h>
#include <thread>

namespace lilo {
namespace {

using namespace std::chrono_literals;

TEST(MetricsWriter, WritesWhatItWasGivenBeforeItEnds) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/metrics";
  { EXPECT_FALSE(MetricsWriter().write(path, "the last")); }
  EXPECT_EQ(text_of(path), "the last");
}

TEST(MetricsWriter, WritesWhereItIsTold) {
  const TemporaryFolder folder;
  const std::string one = folder.path() + "/one", other = folder.path() + "/other";
  {
    MetricsWriter writer;
    writer.write(one, "first");
    while (text_of(one) != "first") std::this_thread::sleep_for(1ms);
    while (!std::filesystem::exists(other)) {
      writer.write(other, "second");  // unless it is still at the first
      std::this_thread::sleep_for(1ms);
    }
  }
  EXPECT_EQ(text_of(one), "first");
  EXPECT_EQ(text_of(other), "second");
}

std::atomic<bool> disk_answers{false};
std::atomic<int> texts_written{0};

std::error_code write_when_the_disk_answers(const std::string&, std::string_view text) {
  while (!disk_answers) std::this_thread::sleep_for(1ms);
  texts_written += text == "taken" ? 1 : 100;
  return {};
}

// A disk that does not answer holds the writer's thread and nobody else, and does not go unnoticed.
TEST(MetricsWriter, WaitsForNoDisk) {
  disk_answers = false;
  texts_written = 0;
  {
    MetricsWriter writer(write_when_the_disk_answers, 0s);
    EXPECT_FALSE(writer.write("a file", "taken"));
    for (int k = 0; k < 100; ++k)
      EXPECT_EQ(writer.write("a file", "left out"), std::errc::device_or_resource_busy);
    EXPECT_EQ(texts_written, 0);
    disk_answers = true;
  }
  EXPECT_EQ(texts_written, 1);
}

TEST(MetricsWriter, LetsADiskBeBusyForAMoment) {
  disk_answers = false;
  MetricsWriter writer(write_when_the_disk_answers, 1h);
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(writer.write("a file", "taken or left out"));
  disk_answers = true;
}

TEST(MetricsWriter, TellsThatItCannotWrite) {
  MetricsWriter writer;
  std::error_code error = writer.write("/nonexistent/lilo.prom", "x");
  EXPECT_FALSE(error) << "not known yet";
  while (!error) {
    std::this_thread::sleep_for(1ms);
    error = writer.write("/nonexistent/lilo.prom", "x");
  }
  EXPECT_EQ(error, std::errc::no_such_file_or_directory);
}

TEST(MetricsWriter, WithoutAFileThereIsNoThread) {
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const auto before = threads();
  MetricsWriter writer;
  EXPECT_FALSE(writer.write("", "x"));
  EXPECT_EQ(threads(), before);
}

}  // namespace
}  // namespace lilo
