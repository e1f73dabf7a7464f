// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/sim_command.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>

/// The command line of `lilo sim`.
namespace lilo::sim {
namespace {

namespace fs = std::filesystem;

class SimCommand : public testing::Test {
 protected:
  SimCommand() : folder_(testing::TempDir() + "lilo_sim_" + std::to_string(getpid())) {
    fs::remove_all(folder_);
  }
  ~SimCommand() override { fs::remove_all(folder_); }

  /// What it complains of; "" where it ran.
  [[nodiscard]] std::string complaint(const std::string& options) const {
    CLI::App app;
    add_sim_command(app);
    try {
      app.parse("sim " + folder_ + " --quiet " + options);
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return "";
  }
  void write(const std::string& name) const {
    fs::create_directories(folder_);
    std::ofstream(folder_ + "/" + name) << "mine";
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ + "/" + name).rdbuf();
    return text.str();
  }

  const std::string folder_;
};

TEST_F(SimCommand, RefusesNumbersThatAreNone) {
  for (const char* option : {"--duration-s", "--speed-mps", "--rpm", "--loss", "--tilt-deg",
                             "--roll-deg", "--sensor-height-m", "--range-sigma-m", "--host-step-s",
                             "--hour-wrap-at-s", "--turn-rate-dps", "--robot-box"}) {
    for (const char* value : {"nan", "-nan", "inf", "-inf", "1e999"}) {
      const std::string said = complaint(std::string(option) + " " + value);
      EXPECT_NE(said.find(std::string(option) + ": expected a number from "), std::string::npos)
          << option << " " << value << ": " << said;
    }
  }
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(SimCommand, RefusesABoxThatIsNone) {
  const auto expect_refused = [this](const std::string& box, const std::string& why) {
    EXPECT_NE(complaint("--robot-box=" + box).find("--robot-box: expected " + why),
              std::string::npos)
        << box;
  };
  expect_refused("-2,-1,-1,1,-1", "6 numbers for each box, found 5");
  expect_refused("-2,-1,-1,1,-1,1,1", "6 numbers for each box, found 7");
  expect_refused("-2,-1,1,-1,-1,1", "from below to, found 1 and -1");
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(SimCommand, OverwritesNothingUnasked) {
  EXPECT_EQ(complaint("--duration-s 0.3"), "");
  const std::string recording = content("data.pcap");
  EXPECT_NE(complaint("--duration-s 0.4").find("found a recording of lilo sim (--force"),
            std::string::npos);
  EXPECT_EQ(content("data.pcap"), recording);
  fs::remove_all(folder_);
  write("data.pcap");
  EXPECT_NE(complaint("--duration-s 0.3").find("found files (--force"), std::string::npos);
  EXPECT_EQ(content("data.pcap"), "mine");
  EXPECT_EQ(complaint("--duration-s 0.3 --force"), "");
  EXPECT_GT(fs::file_size(folder_ + "/data.pcap"), 1000U);
}

TEST_F(SimCommand, TakesAnEmptyFolder) {
  fs::create_directories(folder_);
  EXPECT_EQ(complaint("--duration-s 0.3"), "");
}

}  // namespace
}  // namespace lilo::sim
