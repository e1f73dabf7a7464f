// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/metrics_file.hpp"

#include "tests/daemon/text_of.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace lilo {
namespace {

TEST(MetricsFile, IsReplacedWholeAndReadable) {
  const std::string path = testing::TempDir() + "lilo_prom_" + std::to_string(getpid());
  const mode_t before = umask(0077);
  ASSERT_FALSE(replace_file(path, "one"));
  ASSERT_FALSE(replace_file(path, "two"));
  umask(before);
  EXPECT_EQ(text_of(path), "two");
  struct stat status {};
  stat(path.c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
  EXPECT_FALSE(std::filesystem::exists(path + ".new"));
  std::filesystem::remove(path);
  EXPECT_EQ(replace_file("/nonexistent/lilo.prom", "x"), std::errc::no_such_file_or_directory);
}

// What somebody else put in the place of the draft is not written to, and nobody waits for it.
TEST(MetricsFile, NeitherFollowsLinksNorWaitsForPipes) {
  const std::string path = testing::TempDir() + "lilo_draft_" + std::to_string(getpid());
  const std::string draft = path + ".new", victim = path + ".victim";
  std::ofstream(victim) << "precious";
  ASSERT_EQ(symlink(victim.c_str(), draft.c_str()), 0);
  EXPECT_EQ(replace_file(path, "x"), std::errc::too_many_symbolic_link_levels);
  EXPECT_EQ(text_of(victim), "precious");
  std::filesystem::remove(draft);
  ASSERT_EQ(mkfifo(draft.c_str(), 0600), 0);
  EXPECT_EQ(replace_file(path, "x"), std::errc::no_such_device_or_address) << "nobody reads it";
  const int reader = open(draft.c_str(), O_RDONLY | O_NONBLOCK);
  EXPECT_TRUE(replace_file(path, "x")) << "somebody does";
  close(reader);
  EXPECT_FALSE(std::filesystem::exists(path));
  for (const std::string& file : {draft, victim}) std::filesystem::remove(file);
}

TEST(MetricsFile, SaysWhatTheSystemSays) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 1000, .rlim_max = before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string path = testing::TempDir() + "lilo_full_" + std::to_string(getpid());
  const std::error_code error = replace_file(path, std::string(5000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(error, std::errc::file_too_large);
  EXPECT_FALSE(std::filesystem::exists(path) || std::filesystem::exists(path + ".new"));
}

// A reader that comes at any time reads one of the texts, whole.
TEST(MetricsFile, ReadersNeverSeeHalfOfIt) {
  const std::string path = testing::TempDir() + "lilo_whole_" + std::to_string(getpid());
  const std::string one(8000, '1'), two(50'000, '2');
  ASSERT_FALSE(replace_file(path, one));
  std::atomic<bool> stop{false};
  std::atomic<int> writes{0};
  std::thread writer([&] {
    for (; !stop; ++writes) EXPECT_FALSE(replace_file(path, writes % 2 == 0 ? two : one));
  });
  while (writes < 200) {
    const std::string text = text_of(path);
    EXPECT_TRUE(text == one || text == two) << text.size() << " bytes";
  }
  stop = true;
  writer.join();
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace lilo
