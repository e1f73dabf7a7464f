// SPDX-License-Identifier: BSD-3-Clause
#include "config/config.hpp"
#include "config/print_config.hpp"
#include "core/odometry.hpp"
#include "tests/daemon/lilod_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/stat.h>
#include <unistd.h>

namespace lilo {
namespace {

const std::string kLilod = LILO_BIN_DIR "/lilod";

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(CommandLine, VersionAndHelp) {
  const std::string version = run_to_end({kLilod, "--version"}).output;
  EXPECT_EQ(version.rfind("lilod " LILO_VERSION " (", 0), 0U) << version;
  EXPECT_EQ(lines(version), 1) << version;
  const Finished help = run_to_end({kLilod, "--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* option : {"--config", "--check-config", "--print-config", "--version"}) {
    EXPECT_NE(help.output.find(option), std::string::npos) << option;
  }
}

TEST(CommandLine, NoConfigurationIsOneLine) {
  const Finished run = run_to_end({kLilod});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.error, "lilod: --config FILE is required (lilod --help)\n");
}

TEST(CommandLine, UnknownOptionIsRefused) {
  EXPECT_EQ(run_to_end({kLilod, "--no-such-option"}).exit_code, 2);
}

TEST(CommandLine, ChecksTheShippedFiles) {
  for (const char* name :
       {"/vlp16.yaml", "/vlp32c.yaml", "/hdl32e.yaml", "/hdl64e.yaml", "/vls128.yaml"}) {
    const std::string path = std::string(LILO_CONFIG_DIR) + name;
    const Finished run = run_to_end({kLilod, "--check-config", "--config", path});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    EXPECT_EQ(run.output, path + ": ok\n");
  }
}

TEST(CommandLine, PrintsWhatIsInForce) {
  const TemporaryFile file("print.yaml", "udp:\n  data_port: 4711\n");
  const Finished run = run_to_end({kLilod, "--print-config", "--config", file.path()});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.output, print_config(load_config(file.path())));
  EXPECT_NE(run.output.find("data_port: 4711"), std::string::npos);
}

// Each kind of bad file: one clear line a mistake, exit code 2, with or without --check-config.
TEST(CommandLine, BadFilesAreOneLineEach) {
  struct Case {
    const char* name;
    const char* yaml;
    const char* says;
  };
  for (const Case& c :
       {Case{"unknown", "udp:\n  port: 1\n", ":2:3: udp.port: expected a known key"},
        Case{"type", "udp:\n  data_port: many\n", ":2:14: udp.data_port: expected a whole number"},
        Case{"range", "udp:\n  data_port: 99999\n", ", found 99999"},
        Case{"syntax", "udp: [\n", "expected YAML"}}) {
    const TemporaryFile file("bad.yaml", c.yaml);
    for (const bool check : {true, false}) {
      std::vector<std::string> words{kLilod, "--config", file.path()};
      if (check) words.emplace_back("--check-config");
      const Finished run = run_to_end(words);
      EXPECT_EQ(run.exit_code, 2) << c.name;
      EXPECT_EQ(lines(run.error), 1) << run.error;
      EXPECT_EQ(run.error.rfind(file.path(), 0), 0U) << run.error;
      EXPECT_NE(run.error.find(c.says), std::string::npos) << run.error;
    }
  }
  const Finished missing = run_to_end({kLilod, "--config", "/nonexistent.yaml"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_EQ(missing.error,
            "/nonexistent.yaml: expected a readable YAML file, found: No such file or directory\n");
}

// No sensor can start with a bad calibration, and a restart would not mend it. A pipe is not waited
// for.
TEST(CommandLine, BadCalibrationsAreBadConfigurations) {
  const TemporaryFile rubbish("rubbish.yaml", "lasers: 3\n");
  const std::string pipe = testing::TempDir() + "lilo_pipe_" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  struct Case {
    std::string file;
    const char* says;
  };
  for (const Case& c : {Case{"/nonexistent/db.xml", "found No such file or directory"},
                        Case{rubbish.path(), "expected a list \"lasers\""},
                        Case{pipe, "expected a calibration file, found no regular file"}}) {
    const TemporaryFile config("calibrated.yaml",
                               "sensor:\n  model: hdl64e\n  calibration_file: " + c.file + "\n");
    for (const bool check : {true, false}) {
      std::vector<std::string> words{kLilod, "--config", config.path()};
      if (check) words.emplace_back("--check-config");
      const Finished run = run_to_end(words);
      EXPECT_EQ(run.exit_code, 2) << c.file;
      EXPECT_EQ(lines(run.error), 1) << run.error;
      EXPECT_EQ(run.error.rfind(config.path() + ": sensor.calibration_file: " + c.file, 0), 0U)
          << run.error;
      EXPECT_NE(run.error.find(c.says), std::string::npos) << run.error;
    }
  }
  std::filesystem::remove(pipe);
}

// An address that is not this computer's: one line, and no READY.
TEST(CommandLine, AddressThatCannotBeBoundIsOneLine) {
  const TemporaryFile file("bind.yaml", "udp:\n  bind_address: 203.0.113.1\n");
  const Finished run = run_to_end({kLilod, "--config", file.path()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(lines(run.error), 1) << run.error;
  EXPECT_NE(run.error.find("203.0.113.1"), std::string::npos) << run.error;
}

TEST(CommandLine, StopsOnSigtermAndSaysSo) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  EXPECT_EQ(lilod.stop(), 0) << lilod.process().standard_error();
  EXPECT_TRUE(lilod.systemd().wait_for("STOPPING=1", std::chrono::seconds(1)));
}

/// Files that the process has in its memory: its program first, then libraries.
std::string mapped_files(const ChildProcess& process) {
  std::ifstream maps("/proc/" + std::to_string(process.pid()) + "/maps");
  return {std::istreambuf_iterator<char>(maps), {}};
}

TEST(Paper, HasAProgramOfItsOwn) {
  if (!has_profile(Profile::paper)) GTEST_SKIP() << "this build has no profile paper";
  Lilod usual;
  ASSERT_TRUE(usual.wait_ready());
  EXPECT_EQ(mapped_files(usual.process()).find("libopencv"), std::string::npos);
  Lilod paper("odometry: {profile: paper}\n");
  ASSERT_TRUE(paper.wait_ready());
  const std::string files = mapped_files(paper.process());
  EXPECT_NE(files.find("/libexec/lilod/lilod-paper\n"), std::string::npos);
  EXPECT_NE(files.find("libopencv"), std::string::npos);
}

TEST(Paper, IsMissedInOneLine) {
  const std::string folder = unique_path("alone");
  std::filesystem::create_directories(folder + "/sbin");
  std::filesystem::copy(kLilod, folder + "/sbin/lilod");
  const TemporaryFile file("paper.yaml", "odometry: {profile: paper}\n");
  const Finished run = run_to_end({folder + "/sbin/lilod", "--config", file.path()});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.error, file.path() +
                           ": odometry.profile: expected default, or paper and the program " +
                           folder +
                           "/libexec/lilod/lilod-paper (package lilo-tools), found paper "
                           "and: No such file or directory\n");
  std::filesystem::remove_all(folder);
}

// What the system refuses is a loud warning, never the end.
TEST(CommandLine, RefusedRealTimeIsAWarning) {
  Lilod lilod("realtime:\n  worker_cpu: 1000\n", {{"JOURNAL_STREAM", "1:1"}});
  ASSERT_TRUE(lilod.wait_ready());
  EXPECT_EQ(lilod.stop(), 0);
  EXPECT_NE(lilod.process().standard_error().find(
                "<4>NOT real time as configured: lilo-worker: cannot pin to cpu 1000"),
            std::string::npos)
      << lilod.process().standard_error();
}

}  // namespace
}  // namespace lilo
