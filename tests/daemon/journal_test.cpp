// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/event.hpp"
#include "daemon/journal_socket.hpp"
#include "daemon/log.hpp"
#include "daemon/story.hpp"
#include "tests/daemon/sockets.hpp"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// What lilod tells the journal, by a socket that stands in for journald's.
namespace lilo {
namespace {

using std::chrono::milliseconds;

TEST(JournalSocket, SendsFieldsAsTheProtocolSays) {
  NotifySocket journald;  // it is a datagram socket all the same
  JournalSocket socket(journald.path());
  using Sent = JournalSocket::Sent;
  EXPECT_EQ(socket.send({{"MESSAGE", "one line"}, {"STATUS", ""}, {"PRIORITY", "6"}}), Sent::yes);
  ASSERT_TRUE(journald.wait_for("MESSAGE=one line\nPRIORITY=6", milliseconds(1000)));
  EXPECT_EQ(journald.log().find("STATUS"), std::string::npos) << "what is not known is left out";
  EXPECT_EQ(socket.send({{"MESSAGE", "two\nlines"}}), Sent::yes);
  const std::string binary = "MESSAGE\n" + std::string("\x09\0\0\0\0\0\0\0", 8) + "two\nlines\n";
  journald.wait_for("two", milliseconds(1000));
  EXPECT_NE(journald.log().find(binary), std::string::npos);
}

TEST(JournalSocket, NeverWaits) {
  using Sent = JournalSocket::Sent;
  EXPECT_EQ(JournalSocket("").send({{"MESSAGE", "x"}}), Sent::no);
  EXPECT_EQ(JournalSocket("/nonexistent/socket").send({{"MESSAGE", "x"}}), Sent::no);
  const NotifySocket deaf;
  JournalSocket socket(deaf.path());
  Sent sent = Sent::yes;
  for (int k = 0; k < 10'000 && sent == Sent::yes; ++k) sent = socket.send({{"MESSAGE", "x"}});
  EXPECT_EQ(sent, Sent::full);
}

// One entry in the catalog for each event, and none for another.
TEST(Events, AreAllInTheCatalog) {
  std::ifstream file(LILO_CATALOG_FILE);
  std::set<std::string> found;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("-- ", 0) != 0) continue;
    EXPECT_TRUE(found.insert(line.substr(3)).second) << line;
  }
  std::set<std::string> ids;
  for (std::size_t k = 0; k < kEventCount; ++k)
    ids.insert(std::string(describe(static_cast<Event>(k)).message_id));
  EXPECT_EQ(ids.size(), kEventCount);
  EXPECT_EQ(found, ids);
}

/// The default logger of this process, and what it says of a story.
class StoryTest : public testing::Test {
 protected:
  StoryTest() {
    setenv("LILO_JOURNAL_SOCKET", journald_.path().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    before_ = spdlog::default_logger();
    start_log(LogLevel::info, "front");
    set_log_context("0123456789abcdef", "tracking");
    health_.sensor.model = SensorModel::vlp16;
    health_.sensor.sensor_ipv4 = 0xc0a801c9;
    health_.sensor.rpm = 600.0;
  }
  ~StoryTest() override {
    spdlog::set_default_logger(before_);
    unsetenv("LILO_JOURNAL_SOCKET");  // NOLINT(concurrency-mt-unsafe)
  }

  void poses(int count, TrackingStatus status) {
    for (int k = 0; k < count; ++k) {
      report_.estimate.status = status;
      report_.estimate.T_odom_sensor.translation_m.x() += 0.5;
      story_.note(report_);
    }
  }
  /// What a second tells.
  std::string second() {
    story_.second(health_);
    const std::size_t before = journald_.log().size();
    while (journald_.wait_for("MESSAGE=", milliseconds(20))) {
    }
    return journald_.log().substr(before);
  }
  static std::string id(Event event) {
    return "MESSAGE_ID=" + std::string(describe(event).message_id);
  }

  NotifySocket journald_;
  std::shared_ptr<spdlog::logger> before_;
  Story story_;
  Health health_;
  PoseReport report_;
};

TEST_F(StoryTest, TellsOfTheSensorOnceAndOfItsChanges) {
  const std::string first = second();
  for (const std::string& part :
       {std::string(
            "MESSAGE=sensor: vlp16 at 192.168.1.201, 600 rpm, returns strongest, clock host"),
        id(Event::sensor_found), std::string("PRIORITY=6"), std::string("INSTANCE=front"),
        std::string("SESSION=0123456789abcdef"), std::string("STATUS=tracking")})
    EXPECT_NE(first.find(part), std::string::npos) << part << " in " << first;
  EXPECT_EQ(second(), "");
  health_.sensor.rpm = 603.0;
  EXPECT_EQ(second(), "") << "that is the same speed";
  health_.sensor.clock = ClockSource::gps;
  EXPECT_NE(second().find("clock gps"), std::string::npos);
}

TEST_F(StoryTest, TellsOnceThatScansAreLevelled) {
  second();
  health_.tilt_deg = 168.64;
  const std::string told = second();
  EXPECT_NE(told.find("sensor: upside down, its z axis is 168.6 deg off"), std::string::npos)
      << told;
  EXPECT_NE(told.find(id(Event::sensor_levelled)), std::string::npos) << told;
  EXPECT_EQ(second(), "");
}

TEST_F(StoryTest, TellsWorseAtOnceAndBetterWhenItLasts) {
  second();
  poses(10, TrackingStatus::tracking);
  EXPECT_NE(second().find(id(Event::tracking)), std::string::npos);
  report_.estimate.weak_count = 1;
  report_.estimate.weak_directions[0].direction << 1, 0, 0, 0, 0, 0;
  report_.estimate.weak_directions[0].from_scan = 0.03;
  poses(10, TrackingStatus::degraded);
  const std::string degraded = second();
  EXPECT_NE(degraded.find("degraded: 10 of 10 poses, along x the scan said 3 % only"),
            std::string::npos)
      << degraded;
  EXPECT_NE(degraded.find("PRIORITY=4"), std::string::npos);
  report_.estimate.weak_count = 0;
  for (int k = 0; k < 2; ++k) {
    poses(10, TrackingStatus::tracking);
    EXPECT_EQ(second(), "") << k;
  }
  poses(10, TrackingStatus::tracking);
  EXPECT_NE(second().find("tracking again after"), std::string::npos);
}

TEST_F(StoryTest, SaysThatTheMotionIsInDoubt) {
  second();
  poses(10, TrackingStatus::tracking);
  second();
  report_.estimate.is_motion_doubtful = true;
  poses(10, TrackingStatus::degraded);
  const std::string degraded = second();
  EXPECT_NE(degraded.find("degraded: 10 of 10 poses, its motion is in doubt"), std::string::npos)
      << degraded;
}

TEST_F(StoryTest, SaysThatTheLastMetresAreUncertain) {
  second();
  poses(10, TrackingStatus::tracking);
  second();
  report_.estimate.is_uncertain = true;
  poses(10, TrackingStatus::degraded);
  const std::string degraded = second();
  EXPECT_NE(
      degraded.find("degraded: 10 of 10 poses, over the last 10 m it may be off by 1 m or 3 deg"),
      std::string::npos)
      << degraded;
}

TEST_F(StoryTest, SaysThatTheSessionIsNotConfirmed) {
  second();
  poses(10, TrackingStatus::tracking);
  second();
  report_.estimate.is_confirmed = false;
  poses(10, TrackingStatus::degraded);
  const std::string degraded = second();
  EXPECT_NE(degraded.find("degraded: 10 of 10 poses, too few good alignments in a row"),
            std::string::npos)
      << degraded;
}

// Motion of 0.5 m a pose; the place found lies 2 m to the left of where it would have led.
TEST_F(StoryTest, TellsHowFarThePredictionWasWrong) {
  second();
  poses(10, TrackingStatus::tracking);
  second();
  poses(3, TrackingStatus::lost);
  EXPECT_NE(second().find("lost: 3 of 3 poses are the prediction alone"), std::string::npos);
  report_.estimate.T_odom_sensor.translation_m.y() += 2.0;
  poses(1, TrackingStatus::tracking);
  const std::string found = second();
  EXPECT_NE(found.find("place found again after 3 lost poses, 2.00 m and 0.0 deg"),
            std::string::npos)
      << found;
  EXPECT_NE(found.find(id(Event::relocalized)), std::string::npos);
}

TEST_F(StoryTest, NamesTheWrongSensorOnceWhileItSends) {
  second();
  health_.sensor.configured = SensorModel::vlp16;
  health_.sensor.refused = {.packets = 100, .model = SensorModel::hdl64e};
  EXPECT_EQ(second(), "") << "long ago";
  health_.recent[Fault::wrong_sensor_packets] = 100;
  health_.totals[Fault::wrong_sensor_packets] = 100;
  const std::string first = second();
  for (const std::string& part :
       {std::string(
            "MESSAGE=packets of an HDL-64E refused, configured is VLP-16: set sensor.model\n"),
        id(Event::sensor_refused), std::string("PRIORITY=4")})
    EXPECT_NE(first.find(part), std::string::npos) << part << " in " << first;
  EXPECT_EQ(first.find(id(Event::faults)), std::string::npos) << "one line";
  health_.sensor.refused.packets = 900;
  EXPECT_EQ(second(), "") << "the same sensor";
  health_.sensor.refused = {.packets = 901, .model = SensorModel::vlp32c, .product_id = 0x28};
  EXPECT_NE(second().find("packets of a VLP-32C"), std::string::npos);
  health_.recent = {};
  EXPECT_EQ(second(), "");
  health_.recent[Fault::wrong_sensor_packets] = 1;
  EXPECT_NE(second().find("packets of a VLP-32C"), std::string::npos) << "it came back";
}

// Two wrong models by turns are two causes, but no reason to fill the disk.
TEST_F(StoryTest, WrongSensorsByTurnsDoNotFillTheJournal) {
  second();
  health_.recent[Fault::wrong_sensor_packets] = 1;
  std::size_t lines = 0;
  for (int k = 0; k < 50; ++k) {
    health_.sensor.refused = {.packets = 1,
                              .model = k % 2 == 0 ? SensorModel::hdl32e : SensorModel::hdl64e};
    if (!second().empty()) ++lines;
  }
  EXPECT_EQ(lines, 6U) << "in a minute";
}

TEST_F(StoryTest, WhatComesAndGoesDoesNotFillTheJournal) {
  second();
  std::size_t lines = 0;
  for (int k = 0; k < 100; ++k) {
    health_.flow = k % 2 == 0 ? Flow::no_packets : Flow::all;
    if (!second().empty()) ++lines;
  }
  EXPECT_GE(lines, 6U);
  EXPECT_LE(lines, 12U) << "six of each kind in a minute";
}

}  // namespace
}  // namespace lilo
