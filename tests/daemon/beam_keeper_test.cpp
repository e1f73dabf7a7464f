// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/beam_keeper.hpp"

#include "drivers/beam_file.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace lilo {
namespace {

namespace fs = std::filesystem;

class BeamKeeperTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directory(directory_); }
  void TearDown() override { fs::remove_all(directory_); }

  void find(double elevation_rad) {
    BeamEstimate beams;
    beams.ring_count = 16;
    beams.elevation_rad[1] = elevation_rad;
    beams.elevation_sigma_rad.fill(1e-4);
    beams.eccentricity_sigma_rad = 1e-3;
    beams_.store(beams);
  }
  /// What the file has of ring 1.
  [[nodiscard]] double in_file_rad() const { return read_beams(path_).elevation_rad[1]; }

  const std::string directory_ =
      testing::TempDir() + "lilo_beam_keeper_" + std::to_string(getpid());
  const std::string path_ = kept_beams_path(directory_);
  boost::asio::io_context io_;
  Snapshot<BeamEstimate> beams_;
};

TEST_F(BeamKeeperTest, WritesOnceAMinuteAndAtTheEnd) {
  BeamKeeper keeper(io_, beams_, directory_);
  find(1e-3);
  for (int second = 1; second < 60; ++second) keeper.look();
  EXPECT_FALSE(fs::exists(path_));
  keeper.look();
  const auto work = boost::asio::make_work_guard(io_);
  ASSERT_EQ(io_.run_one_for(std::chrono::seconds(10)), 1U) << "the saver's thread has written";
  EXPECT_DOUBLE_EQ(in_file_rad(), 1e-3);
  find(2e-3);
  keeper.finish();
  EXPECT_DOUBLE_EQ(in_file_rad(), 2e-3);
  EXPECT_DOUBLE_EQ(kept_beams(directory_).elevation_rad[1], 2e-3);
}

TEST_F(BeamKeeperTest, WritesNothingWhereNothingWasFound) {
  BeamKeeper keeper(io_, beams_, directory_);
  keeper.finish();
  find(0.0);
  keeper.finish();
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(BeamKeeperTest, WithoutAFolderOrAFileNothingIsKnown) {
  EXPECT_EQ(kept_beams("").ring_count, 0);
  EXPECT_EQ(kept_beams(directory_).ring_count, 0);
  find(1e-3);
  BeamKeeper(io_, beams_, "").finish();
  BeamKeeper(io_, beams_, directory_ + "/none").finish();
}

TEST_F(BeamKeeperTest, ABadFileIsNoReasonNotToStart) {
  std::ofstream(path_) << "rings: many";
  EXPECT_EQ(kept_beams(directory_).ring_count, 0);
  fs::remove(path_);
  fs::create_directory(path_);
  EXPECT_EQ(kept_beams(directory_).ring_count, 0);
}

}  // namespace
}  // namespace lilo
