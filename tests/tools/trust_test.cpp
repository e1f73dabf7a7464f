// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/trust.hpp"

#include "tests/tools/temporary_file.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/eval/report.hpp"
#include "tools/record/recording.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numbers>

namespace lilo {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// 1.05 m a pose along a road that bends left by a degree a pose, so ten poses are the first ten
/// metres; and an estimate without error.
struct Drive {
  PoseStream estimate;
  std::vector<Pose> truth;

  explicit Drive(int count) {
    const Pose step{so3_exp({0, 0, kDegree}), {1.05, 0, 0}};
    Pose pose{so3_exp({0.1, 0.2, 1.5}), {50, 60, 7}};
    for (int k = 0; k < count; ++k) {
      truth.push_back(pose);
      estimate.poses.push_back({{k, truth.front().inverse() * pose}, TrackingStatus::tracking});
      pose = pose * step;
    }
  }
  [[nodiscard]] Pose& pose(int k) { return estimate.poses[static_cast<std::size_t>(k)].pose.pose; }
  /// The sensor is really `error` beyond where the estimate says from pose `first` on.
  void spoil_from(int first, const Pose& error) {
    for (int k = first; k < static_cast<int>(truth.size()); ++k)
      pose(k) = pose(k) * error.inverse();
  }
  [[nodiscard]] Trust judged() const {
    Trajectory all{.name = "truth", .has_times = true};
    for (std::size_t k = 0; k < truth.size(); ++k)
      all.poses.push_back({static_cast<std::int64_t>(k), truth[k]});
    return trust(estimate, associate(trajectory(estimate), all));
  }
};

TEST(Nees, IsTheErrorInSigmasSquaredInTheSensorsFrame) {
  Drive drive(100);
  drive.spoil_from(1, {so3_exp({0, 0, 0.02}), {0.3, -0.1, 0.0}});
  Vector6d sigma;
  sigma << 0.1, 0.2, 1.0, 1.0, 1.0, 0.005;
  for (SaidPose& said : drive.estimate.poses) said.covariance = sigma.cwiseAbs2().asDiagonal();
  const Trust trust = drive.judged();
  ASSERT_TRUE(trust.nees);
  EXPECT_NEAR(*trust.nees, 9.0 + 0.25 + 16.0, 1e-9);
  EXPECT_EQ(trust.nees_count, 99) << "the first pose has no error by definition";
}

// x and y are one unknown, 1 m each, that is known to 0.1 m in their difference.
TEST(Nees, TakesCorrelationsIntoAccount) {
  Drive drive(3);
  drive.spoil_from(1, {Eigen::Quaterniond::Identity(), {0.5, 0.7, 0.0}});
  Matrix6d covariance = Matrix6d::Identity();
  covariance(0, 1) = covariance(1, 0) = 0.995;  // (x - y) / sqrt 2: 0.005, (x + y) / sqrt 2: 1.995
  for (SaidPose& said : drive.estimate.poses) said.covariance = covariance;
  EXPECT_NEAR(*drive.judged().nees, 0.02 / 0.005 + 0.72 / 1.995, 1e-9);
}

TEST(Nees, EndsWithTheFirstSessionAndSkipsWhatIsNotSaid) {
  Drive drive(10);
  EXPECT_FALSE(drive.judged().nees);
  drive.estimate.poses[4].covariance = Matrix6d::Identity();
  for (std::size_t k = 6; k < 10; ++k) {
    drive.estimate.poses[k].covariance = Matrix6d::Identity();
    drive.estimate.poses[k].session = 1;
  }
  const Trust trust = drive.judged();
  EXPECT_EQ(trust.nees_count, 1);
  EXPECT_EQ(trust.sessions, 2);
}

TEST(Nees, OfPosesCalledTrackingIsToldApart) {
  Drive drive(5);
  drive.spoil_from(1, {Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0}});
  drive.spoil_from(4, {Eigen::Quaterniond::Identity(), {2.0, 0.0, 0.0}});
  for (SaidPose& said : drive.estimate.poses) said.covariance = Matrix6d::Identity();
  drive.estimate.poses[4].status = TrackingStatus::lost;
  EXPECT_NEAR(*drive.judged().nees, (1.0 + 1.0 + 1.0 + 9.0) / 4.0, 1e-9);
  EXPECT_NEAR(*drive.judged().nees_tracking, 1.0, 1e-9);
}

TEST(FalseTracking, IsCountedUntilTheErrorLiesTenMetresBack) {
  Drive drive(100);
  drive.spoil_from(50, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.001}});
  // Poses 50 to 59 have one before the jump 10 m back.
  EXPECT_EQ(drive.judged().false_tracking, 10U);
  EXPECT_NEAR(drive.judged().false_tracking_percent(), 10.0, 1e-12);
  Drive below(100);
  below.spoil_from(50, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.999}});
  EXPECT_EQ(below.judged().false_tracking, 0U);
}

TEST(FalseTracking, TakesThreeDegrees) {
  for (const double degrees : {2.99, 3.01}) {
    Drive drive(100);
    drive.spoil_from(95, {so3_exp({degrees * kDegree, 0, 0}), {0, 0, 0}});
    EXPECT_EQ(drive.judged().false_tracking, degrees > 3.0 ? 5U : 0U);
  }
}

TEST(FalseTracking, OnlyPosesCalledTrackingCount) {
  Drive drive(100);
  drive.spoil_from(50, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}});
  for (int k = 50; k < 57; ++k)
    drive.estimate.poses[static_cast<std::size_t>(k)].status = TrackingStatus::degraded;
  const Trust trust = drive.judged();
  EXPECT_EQ(trust.false_tracking, 3U);
  EXPECT_EQ(trust.status_counts, (std::array<std::uint64_t, 4>{0, 93, 7, 0}));
  EXPECT_NEAR(trust.false_tracking_percent(), 300.0 / 93.0, 1e-12);
}

TEST(FalseTracking, ANewSessionIsAnAnnouncedBreak) {
  Drive drive(100);
  drive.spoil_from(50, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 5.0}});
  for (std::size_t k = 50; k < 100; ++k) drive.estimate.poses[k].session = 1;
  EXPECT_EQ(drive.judged().false_tracking, 0U);
  // 4 m into the new session and still seen from its first pose.
  drive.spoil_from(54, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 5.0}});
  EXPECT_EQ(drive.judged().false_tracking, 10U);
}

// Lost for 10 poses and wrong there, found again: the errors of the lost ones are no fault of those
// after them.
TEST(FalseTracking, WhoIsFoundAgainIsRight) {
  Drive drive(100);
  for (int k = 40; k < 50; ++k) {
    drive.pose(k).translation_m.z() += 5.0;
    drive.estimate.poses[static_cast<std::size_t>(k)].status = TrackingStatus::lost;
  }
  EXPECT_EQ(drive.judged().false_tracking, 0U);
}

// Lost for 20 poses and found at a wrong place, without a new session.
TEST(FalseTracking, WhoIsFoundElsewhereIsWrong) {
  Drive drive(100);
  for (std::size_t k = 40; k < 60; ++k) drive.estimate.poses[k].status = TrackingStatus::lost;
  drive.spoil_from(60, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 5.0}});
  EXPECT_EQ(drive.judged().false_tracking, 10U);
}

// Drift that was announced all the way, 4 m within 40 poses, is not held against who tracks again.
TEST(FalseTracking, AnnouncedDriftIsForgiven) {
  Drive drive(100);
  for (int k = 40; k < 80; ++k) {
    drive.spoil_from(k, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.09}});
    drive.estimate.poses[static_cast<std::size_t>(k)].status = TrackingStatus::degraded;
  }
  EXPECT_EQ(drive.judged().false_tracking, 0U);
}

TEST(FalseTracking, AtStandstillIsSeenFromTheFirstPose) {
  Drive drive(30);
  for (std::size_t k = 0; k < 30; ++k) {
    drive.truth[k] = Pose{};
    drive.estimate.poses[k].pose.pose = Pose{};
  }
  drive.spoil_from(20, {Eigen::Quaterniond::Identity(), {0.0, 1.5, 0.0}});
  EXPECT_EQ(drive.judged().false_tracking, 10U);
}

std::string line_of(int k, const std::string& session, const std::string& status) {
  return R"({"seq":)" + std::to_string(k) + R"(,"session":")" + session +
         R"(","pose":{"stamp":{"sec":)" + std::to_string(k) +
         R"(,"nsec":5},"frame_id":"odom","child_frame_id":"velodyne","status":")" + status +
         R"(","position":{"x":)" + std::to_string(k) +
         R"(,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1}}})" + "\n";
}

std::string error_of(const std::string& path) {
  try {
    read_pose_stream(path);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "none";
}

TEST(PoseStream, IsReadLineByLine) {
  const TemporaryFile file(line_of(3, "aa", "initializing") + "\n" + R"({"health":{}})" + "\n" +
                           line_of(4, "aa", "tracking") + line_of(5, "bb", "lost"));
  EXPECT_TRUE(is_pose_stream(file.path()));
  const PoseStream stream = read_pose_stream(file.path());
  ASSERT_EQ(stream.poses.size(), 3U);
  EXPECT_EQ(stream.poses[1].pose.stamp_ns, 4'000'000'005);
  EXPECT_EQ(stream.poses[1].status, TrackingStatus::tracking);
  EXPECT_EQ(stream.poses[2].session, 1);
  EXPECT_EQ(stream.poses[2].pose.pose.translation_m.x(), 5.0);
  EXPECT_FALSE(stream.poses[0].covariance);
}

// What lilo record wrote tells the same, whichever ending it was given.
TEST(PoseStream, IsReadFromMcapToo) {
  const TemporaryFolder folder;
  const std::string lines = folder.path() + "/a.jsonl", mcap = folder.path() + "/a.mcap";
  for (const std::string& file : {lines, mcap}) {
    Recording recording(file);
    recording.take(line_of(3, "aa", "initializing"), 0);
    recording.take(R"({"health":{}})", 1);
    recording.take(line_of(4, "aa", "tracking"), 2);
    recording.take(line_of(5, "bb", "tracking"), 3);
    recording.finish();
    EXPECT_TRUE(is_pose_stream(file));
  }
  const PoseStream a = read_pose_stream(lines), b = read_pose_stream(mcap);
  ASSERT_EQ(a.poses.size(), 3U);
  ASSERT_EQ(b.poses.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(b.poses[k].pose.stamp_ns, a.poses[k].pose.stamp_ns);
    EXPECT_EQ(b.poses[k].status, a.poses[k].status);
    EXPECT_EQ(b.poses[k].session, a.poses[k].session);
  }
  const std::string cut = folder.path() + "/cut.mcap";
  std::ofstream(cut) << "\x89MCAP0\r\n\x05";
  EXPECT_EQ(error_of(cut), cut + ": byte 8: ends early; mcap recover mends it");
}

TEST(PoseStream, MistakesNameTheirLine) {
  const TemporaryFile cut(line_of(3, "aa", "tracking") + R"({"seq":4,"po)");
  EXPECT_EQ(error_of(cut.path()), cut.path() + ":2: expected a datagram of lilod, found none");
  const TemporaryFile back(line_of(3, "aa", "tracking") + line_of(3, "aa", "tracking"));
  EXPECT_EQ(error_of(back.path()),
            back.path() + ":2: expected a later time than in the pose before");
  const TemporaryFile fine(line_of(3, "aa", "fine"));
  EXPECT_EQ(error_of(fine.path()), fine.path() + ":1: expected a status, found 'fine'");
  const TemporaryFile tum("# t x y z qx qy qz qw\n1 0 0 0 0 0 0 1\n");
  EXPECT_FALSE(is_pose_stream(tum.path()));
}

TEST(Trust, IsPartOfTheReport) {
  Drive drive(60);
  drive.spoil_from(50, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}});
  for (SaidPose& said : drive.estimate.poses) said.covariance = Matrix6d::Identity();
  Trajectory truth{.name = "truth", .has_times = true};
  for (std::size_t k = 0; k < 60; ++k)
    truth.poses.push_back({static_cast<std::int64_t>(k), drive.truth[k]});
  const Evaluation evaluation = evaluate(drive.estimate, truth, {}, 10);
  const auto json = nlohmann::json::parse(to_json(evaluation))["trust"];
  EXPECT_EQ(json["false_tracking"], 10);
  EXPECT_NEAR(json["nees"].get<double>(), 10 * 4.0 / 59, 1e-9);
  EXPECT_EQ(json["status"]["tracking"], 60);
  const std::string text = to_text(evaluation);
  for (const char* part : {"100.0 % tracking; 1 session\n",
                           "0.678 over 59 poses, 6 when right; 0.678 where tracking\n",
                           "10 poses, 16.67 % of those called tracking\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  }
  EXPECT_TRUE(nlohmann::json::parse(to_json(evaluate(truth, truth, {}, 10)))["trust"].is_null());
}

}  // namespace
}  // namespace lilo
