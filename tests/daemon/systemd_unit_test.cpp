// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/child_process.hpp"
#include "tests/daemon/text_of.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <unistd.h>

namespace lilo {
namespace {

const std::string kAnalyze = "/usr/bin/systemd-analyze";

/// The unit as it is installed, but for the path of the program, in a folder of its own.
class SystemdUnit : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kAnalyze)) GTEST_SKIP() << kAnalyze << " is not here";
    folder_ = testing::TempDir() + "lilo_unit_" + std::to_string(getpid());
    std::filesystem::create_directories(folder_);
    const std::string unit = text_of(std::string(LILO_UNIT_DIR) + '/' + GetParam());
    text_ = std::regex_replace(unit, std::regex("ExecStart=\\S+/lilod"),
                               "ExecStart=" LILO_BIN_DIR "/lilod");
    std::ofstream(path()) << text_;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path() const { return folder_ + '/' + GetParam(); }
  std::string folder_, text_;
};

TEST_P(SystemdUnit, VerifiesClean) {
  // The manuals are made for the packages; tests/package looks for them.
  const Finished run = run_to_end({kAnalyze, "verify", "--man=no", path()});
  EXPECT_EQ(run.exit_code, 0);
  // Of other units on this machine it may complain; of ours it must not.
  EXPECT_EQ(run.error.find("lilod"), std::string::npos) << run.error;
}

// Exposure 2.0 or lower; the threshold is in tenths.
TEST_P(SystemdUnit, IsHardened) {
  const Finished run =
      run_to_end({kAnalyze, "security", "--offline=true", "--threshold=20", path()});
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const std::size_t verdict = run.output.find("Overall exposure level");
  ASSERT_NE(verdict, std::string::npos) << run.output << run.error;
  std::cout << run.output.substr(verdict);
}

// Hardening copied from elsewhere would take real time away without a word.
TEST_P(SystemdUnit, LeavesRealTimeIn) {
  for (const char* needed :
       {"LimitRTPRIO=80", "LimitMEMLOCK=infinity", "Type=notify", "WatchdogSec=", "ExecReload="}) {
    EXPECT_NE(text_.find(needed), std::string::npos) << needed;
  }
  EXPECT_FALSE(std::regex_search(text_, std::regex("\nRestrictRealtime=")));
  EXPECT_FALSE(std::regex_search(text_, std::regex("\nLimitRTTIME="))) << "kills a late worker";
  EXPECT_FALSE(std::regex_search(text_, std::regex("\nSystemCallFilter=~.*@resources")));
}

// A bad configuration is bad at every start; everything else is tried again.
TEST_P(SystemdUnit, IsNotRestartedWithABadConfiguration) {
  EXPECT_NE(text_.find("\nRestart=on-failure\n"), std::string::npos);
  std::smatch code;
  ASSERT_TRUE(std::regex_search(text_, code, std::regex("\nRestartPreventExitStatus=(.*)\n")));
  std::ofstream(folder_ + "/bad.yaml") << "no_such_key: 1\n";
  const Finished run = run_to_end({LILO_BIN_DIR "/lilod", "--config", folder_ + "/bad.yaml"});
  EXPECT_EQ(std::to_string(run.exit_code), code[1]);
}

INSTANTIATE_TEST_SUITE_P(Shipped, SystemdUnit, testing::Values("lilod.service", "lilod@.service"),
                         [](const auto& test) {
                           return std::string(test.param).starts_with("lilod@") ? "instance"
                                                                                : "single";
                         });

}  // namespace
}  // namespace lilo
