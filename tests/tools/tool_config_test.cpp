// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tool_config.hpp"

#include "tests/tools/temporary_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lilo {
namespace {

TEST(ToolConfig, WithoutAFileIsWhatIsBuiltIn) {
  EXPECT_EQ(tool_config("").sensor.max_range_m, SensorConfig{}.max_range_m);
}

TEST(ToolConfig, ReadsTheFileThenTheProfile) {
  const TemporaryFile file("sensor:\n  max_range_m: 77\n");
  const Config config = tool_config(file.path(), "paper");
  EXPECT_EQ(config.sensor.max_range_m, 77.0);
  EXPECT_EQ(config.odometry.profile, Profile::paper);
}

TEST(ToolConfig, TheCommandLinesSensorIsTheOneThatCounts) {
  const TemporaryFile file("sensor:\n  model: vlp16\n  max_range_m: 77\n");
  const Config config = tool_config(file.path(), "", "hdl64e");
  EXPECT_EQ(config.sensor.model, SensorModel::hdl64e);
  EXPECT_EQ(config.sensor.max_range_m, 77.0);
}

TEST(ToolConfig, NamesTheProfilesWhenAskedForAnother) {
  try {
    (void)tool_config("", "papper");
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("--profile: expected one of "), std::string::npos) << what;
    EXPECT_NE(what.find("paper"), std::string::npos) << what;
    EXPECT_NE(what.find("papper"), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace lilo
