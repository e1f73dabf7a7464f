// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/beam_file.hpp"

#include "drivers/packet_source.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <utility>

namespace lilo {
namespace {

class BeamFile : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  /// Why it is refused; "" when it is not.
  [[nodiscard]] std::string refusal() const {
    try {
      (void)read_beams(path_);
    } catch (const DriverError& error) {
      return error.what();
    }
    return "";
  }
  std::string path_ = testing::TempDir() + "lilo_beams_" + std::to_string(getpid()) + ".yaml";
  void TearDown() override { std::filesystem::remove_all(path_); }
};

TEST_F(BeamFile, HoldsMilliradiansByRing) {
  write(
      "rings: 2\nelevation_mrad: [1.5, -0.25]\nelevation_sigma_mrad: [0.1, 1]\n"
      "eccentricity_mrad: [-0.7, 1.1]\neccentricity_sigma_mrad: 0.05\n");
  const BeamEstimate beams = read_beams(path_);
  EXPECT_EQ(beams.ring_count, 2);
  EXPECT_DOUBLE_EQ(beams.elevation_rad[0], 1.5e-3);
  EXPECT_DOUBLE_EQ(beams.elevation_rad[1], -0.25e-3);
  EXPECT_DOUBLE_EQ(beams.elevation_rad[2], 0.0);
  EXPECT_DOUBLE_EQ(beams.elevation_sigma_rad[0], 0.1e-3);
  EXPECT_DOUBLE_EQ(beams.eccentricity_rad[0], -0.7e-3);
  EXPECT_DOUBLE_EQ(beams.eccentricity_rad[1], 1.1e-3);
  EXPECT_DOUBLE_EQ(beams.eccentricity_sigma_rad, 0.05e-3);
  EXPECT_EQ(beams.common_elevation_rad, 0.0) << "of an earlier version";
  EXPECT_EQ(beams.common_by_path_sigma_rad, 0.0) << "of an earlier version";
}

TEST_F(BeamFile, ReadsWhatItWrites) {
  BeamEstimate beams;
  beams.ring_count = kMaxRings;
  for (std::size_t k = 0; k < kMaxRings; ++k) {
    beams.elevation_rad[k] = 1e-5 * static_cast<double>(k);
    beams.elevation_sigma_rad[k] = 1e-4;
  }
  beams.eccentricity_rad = {1e-3, -2e-3};
  beams.eccentricity_sigma_rad = 5e-5;
  beams.common_elevation_rad = -4e-4;
  beams.common_elevation_sigma_rad = 6e-5;
  beams.common_by_path_rad = -7e-4;
  beams.common_by_path_sigma_rad = 3e-4;
  write(beams_yaml(beams));
  const BeamEstimate read = read_beams(path_);
  for (std::size_t k = 0; k < kMaxRings; ++k)
    EXPECT_NEAR(read.elevation_rad[k], beams.elevation_rad[k], 1e-12);
  EXPECT_NEAR(read.eccentricity_rad[1], -2e-3, 1e-12);
  EXPECT_NEAR(read.eccentricity_sigma_rad, 5e-5, 1e-12);
  EXPECT_NEAR(read.common_elevation_rad, -4e-4, 1e-12);
  EXPECT_NEAR(read.common_elevation_sigma_rad, 6e-5, 1e-12);
  EXPECT_NEAR(read.common_by_path_rad, -7e-4, 1e-12);
  EXPECT_NEAR(read.common_by_path_sigma_rad, 3e-4, 1e-12);
}

TEST_F(BeamFile, RefusesWhatIsNone) {
  EXPECT_NE(refusal().find("expected a beams file"), std::string::npos) << "there is none";
  const std::string good =
      "rings: 1\nelevation_mrad: [0]\nelevation_sigma_mrad: [1]\n"
      "eccentricity_mrad: [0, 0]\neccentricity_sigma_mrad: 1\n";
  write(good);
  EXPECT_EQ(refusal(), "");
  for (const auto& [wrong, named] :
       {std::pair{"", "rings"},
        {"[1, 2]", "rings"},
        {"rings: 129", "rings"},
        {"rings: 1", "elevation_mrad: expected a list of 1"},
        {"rings: 1\nelevation_mrad: [0]\nelevation_sigma_mrad: [0]\n"
         "eccentricity_mrad: [0, 0]\neccentricity_sigma_mrad: 1",
         "more than 0"},
        {"rings: 1\nelevation_mrad: [0]\nelevation_sigma_mrad: [1]\n"
         "eccentricity_mrad: [0, 0]\neccentricity_sigma_mrad: 1\ncommon_elevation_mrad: 1",
         "common_elevation_sigma_mrad"},
        {"rings: 1\nelevation_mrad: [0]\nelevation_sigma_mrad: [1]\n"
         "eccentricity_mrad: [0, 0]\neccentricity_sigma_mrad: 1\ncommon_by_path_mrad: 1",
         "common_by_path_sigma_mrad"},
        {"rings: 2\nelevation_mrad: [0]", "elevation_mrad: expected a list of 2"},
        {"rings: 1\nelevation_mrad: [nan]", "elevation_mrad"},
        {"rings: 1\nelevation_mrad: [30]", "elevation_mrad"},
        {"rings: [", "expected YAML"}}) {
    write(wrong);
    EXPECT_NE(refusal().find(named), std::string::npos) << wrong << ": " << refusal();
  }
}

TEST_F(BeamFile, RefusesAFolder) {
  std::filesystem::create_directory(path_);
  EXPECT_NE(refusal().find("no regular file"), std::string::npos);
}

}  // namespace
}  // namespace lilo
