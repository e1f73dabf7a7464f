// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/gprmc.hpp"
#include "drivers/position_packet.hpp"
#include "drivers/sensor_clock.hpp"
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lilo {
namespace {

using test::build;
using test::Outcome;

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kHourNs = 3600 * kSecondNs;
const std::int64_t kHour = utc_seconds(2024, 5, 14, 9, 0, 0) * kSecondNs;

TEST(SensorClock, WrapsTheHourByNearness) {
  SensorClock clock;
  const std::int64_t before = clock.unwrap(3'599'999'000, kHour - 1'000'000);
  const std::int64_t after = clock.unwrap(326, kHour + 326'000);
  EXPECT_EQ(after - before, 1'326'000);
  EXPECT_EQ(after, kHour + 326'000);
}

TEST(SensorClock, TakesStampsBeyondTheHourAsTheyAre) {
  SensorClock clock;
  const std::int64_t a = clock.unwrap(3'599'999'000, kHour);
  const std::int64_t b = clock.unwrap(3'600'020'000, kHour);  // ros-drivers/velodyne issue 218
  const std::int64_t c = clock.unwrap(21'000, kHour);
  EXPECT_EQ(b - a, 21'000'000);
  EXPECT_EQ(c - b, 1'000'000);
}

TEST(SensorClock, AReorderedPacketAtTheHourDoesNotAddAnHour) {
  SensorClock clock;
  const std::int64_t after = clock.unwrap(500, kHour);
  const std::int64_t late = clock.unwrap(3'599'999'173, kHour);
  EXPECT_EQ(after - late, 1'327'000);
  EXPECT_EQ(clock.unwrap(1827, kHour) - after, 1'327'000);
}

TEST(SensorClock, HostAndSensorOnEitherSideOfTheHour) {
  for (const std::int64_t offset_ns : {-300'000'000LL, 300'000'000LL}) {
    SensorClock clock;
    const std::int64_t line = clock.unwrap(1'000'000, kHour + kSecondNs + offset_ns);
    clock.begin_scan(line);
    EXPECT_EQ(clock.source(), ClockSource::host);
    EXPECT_EQ(clock.to_utc_ns(line), kHour + kSecondNs);  // the sensor's minutes are kept
  }
}

TEST(SensorClock, AFreeRunningSensorIsPlacedByReceiveTime) {
  for (const std::int64_t minutes : {-40, -20, 7, 20, 40}) {
    SensorClock clock;
    const std::int64_t received = kHour + (50 + minutes) * 60 * kSecondNs;
    const std::int64_t line = clock.unwrap(600'000'000, received);
    clock.begin_scan(line);
    EXPECT_EQ(clock.to_utc_ns(line), received) << minutes;
  }
}

TEST(SensorClock, SilenceOfHoursIsCountedByTheHost) {
  SensorClock clock;
  const std::int64_t a = clock.unwrap(1'000'000, kHour + kSecondNs);
  const std::int64_t b = clock.unwrap(2'000'000, kHour + 3 * kHourNs + 2 * kSecondNs);
  EXPECT_EQ(b - a, 3 * kHourNs + kSecondNs);
}

TEST(SensorClock, AStepOfTheHostClockByHoursIsNoSilence) {
  for (const std::int64_t hours : {-1, 1, 5}) {
    SensorClock clock;
    const std::int64_t a = clock.unwrap(1'000'000, kHour + kSecondNs);
    const std::int64_t b = clock.unwrap(1'001'327, kHour + hours * kHourNs + kSecondNs + 1'327'000);
    EXPECT_EQ(b - a, 1'327'000) << hours;
  }
}

TEST(SensorClock, AStepOfTheHostClockDoesNotMoveStampsOfAScan) {
  SensorClock clock;
  const std::int64_t first = clock.unwrap(1'000'000, kHour + kSecondNs);
  clock.begin_scan(first);
  const std::int64_t utc = clock.to_utc_ns(first);
  const std::int64_t second = clock.unwrap(1'001'327, kHour + 900 * kSecondNs);
  EXPECT_EQ(second - first, 1'327'000);
  EXPECT_EQ(clock.to_utc_ns(second) - utc, 1'327'000);
  clock.begin_scan(second);  // one scan astray is no proof
  EXPECT_EQ(clock.to_utc_ns(second) - utc, 1'327'000);
}

TEST(SensorClock, FollowsTheHostWhenItStaysAway) {
  SensorClock clock;
  std::int64_t line = 0;
  const std::int64_t step = 900 * kSecondNs;
  for (std::uint32_t scan = 0; scan < 30; ++scan) {
    const std::uint32_t us = 1'000'000 + scan * 100'000;
    line = clock.unwrap(us, kHour + us * std::int64_t{1000} + (scan > 0 ? step : 0));
    clock.begin_scan(line);
  }
  EXPECT_EQ(clock.to_utc_ns(line), kHour + 3'900'000'000 + step);
}

TEST(SensorClock, FollowsADriftSlowly) {
  SensorClock clock;
  constexpr double kDrift = 50e-6;  // a common quartz
  std::int64_t received = 0, utc = 0, last_utc = 0;
  for (std::uint32_t scan = 0; scan < 10'000; ++scan) {
    const std::uint32_t us = 700'000'000 + scan * 100'000;
    received = kHour + static_cast<std::int64_t>(scan * 1e8 * (1.0 + kDrift));
    const std::int64_t line = clock.unwrap(us, received);
    clock.begin_scan(line);
    utc = clock.to_utc_ns(line);
    if (scan > 0) {
      ASSERT_NEAR(static_cast<double>(utc - last_utc), 1e8, 1e8 * 1.1e-4);
    }
    last_utc = utc;
  }
  EXPECT_NEAR(static_cast<double>(utc - received), 0.0, 2.1e6);  // 50 ms were to be made up
}

TEST(SensorClock, GpsPlacesTheHour) {
  SensorClock clock;
  const std::int64_t line = clock.unwrap(900'000'000, kHour + 7 * kHourNs);  // host is hours off
  clock.gps_fix(900'000'500, kHour + 899 * kSecondNs, kHour + 7 * kHourNs);
  clock.begin_scan(line);
  EXPECT_EQ(clock.source(), ClockSource::gps);
  EXPECT_EQ(clock.to_utc_ns(line), kHour + 900 * kSecondNs);
}

TEST(SensorClock, GpsSentenceOfTheHourBefore) {
  SensorClock clock;
  const std::int64_t line = clock.unwrap(20'000, kHour);
  clock.gps_fix(20'000, kHour - kSecondNs, kHour);  // 08:59:59, heard just after nine
  clock.begin_scan(line);
  EXPECT_EQ(clock.to_utc_ns(line), kHour + 20'000'000);
}

TEST(SensorClock, AnUnsynchronisedSentenceIsNoFix) {
  SensorClock clock;
  const std::int64_t line = clock.unwrap(900'000'000, kHour + 900 * kSecondNs);
  clock.gps_fix(900'000'000, kHour + 500 * kSecondNs, kHour + 900 * kSecondNs);
  clock.begin_scan(line);
  EXPECT_EQ(clock.source(), ClockSource::host);
}

TEST(SensorClock, GpsIsForgottenAfterAMinuteButItsHourStays) {
  SensorClock clock;
  std::int64_t line = clock.unwrap(0, kHour);
  clock.gps_fix(0, kHour, kHour);
  clock.begin_scan(line);
  EXPECT_EQ(clock.source(), ClockSource::gps);
  line = clock.unwrap(61'000'000, kHour + 61 * kSecondNs);
  clock.begin_scan(line);
  EXPECT_EQ(clock.source(), ClockSource::host);
  EXPECT_EQ(clock.to_utc_ns(line), kHour + 61 * kSecondNs);
}

TEST(Gprmc, ReadsTimeDateAndStatus) {
  const auto gps = parse_gprmc(test::gprmc(8, 18, 2, 21, 1, 2016));
  ASSERT_TRUE(gps);
  EXPECT_TRUE(gps->valid);
  EXPECT_EQ(gps->utc_ns, 1'453'364'282 * kSecondNs);  // date -u -d "2016-01-21 08:18:02" +%s
  EXPECT_FALSE(parse_gprmc(test::gprmc(8, 18, 2, 21, 1, 2016, 'V'))->valid);
}

TEST(Gprmc, RefusesWhatIsNoSentence) {
  const std::string good = test::gprmc(8, 18, 2, 21, 1, 2016);
  std::string bad_sum = good;
  bad_sum[8] = '9';
  for (const std::string& text :
       {std::string(), std::string("$GPRMC,"), std::string("$GPRMC,,,,,,,,,,"), bad_sum,
        std::string("$GPGGA,081802,4807,N"), std::string("$GPRMC,256000,A,,,,,,,210116"),
        std::string("$GPRMC,081802,A,,,,,,,320116"), std::string("$GPRMC,08180x,A,,,,,,,210116"),
        good.substr(0, good.size() - 3), std::string(128, '\0'), std::string(128, ',')})
    EXPECT_FALSE(parse_gprmc(text)) << text;
}

TEST(Gprmc, EndsAtAnyOfItsEnds) {
  const std::string sentence = test::gprmc(8, 18, 2, 21, 1, 2016);
  const std::string bare = sentence.substr(0, sentence.size() - 2);
  EXPECT_TRUE(parse_gprmc(bare));
  EXPECT_TRUE(parse_gprmc(bare + std::string(20, '\0')));
  EXPECT_TRUE(parse_gprmc(bare + "\n$GPGGA,"));
  EXPECT_TRUE(parse_gprmc(bare.substr(0, bare.find('*'))));  // no checksum: taken
}

TEST(PositionPacket, NeedsPulseAndFix) {
  const auto parse = [](int pps, char status) {
    const auto packet =
        test::position_packet(5'000'000, pps, test::gprmc(9, 0, 5, 14, 5, 2024, status), 0);
    return parse_position_packet(packet.bytes);
  };
  EXPECT_TRUE(parse(2, 'A')->synchronized());
  EXPECT_FALSE(parse(2, 'V')->synchronized());
  for (const int pps : {0, 1, 3}) EXPECT_FALSE(parse(pps, 'A')->synchronized());
  EXPECT_FALSE(parse_position_packet(std::vector<std::byte>(511)));
  EXPECT_FALSE(parse_position_packet(
      test::position_packet(3'700'000'000, 2, test::gprmc(9, 0, 5, 14, 5, 2024), 0).bytes));
}

TEST(PositionPacket, SentenceMayFillItsFieldToTheLastByte) {
  const std::string sentence = test::gprmc(9, 0, 5, 14, 5, 2024);
  const std::string bare = sentence.substr(0, sentence.size() - 2);  // neither CR LF nor NUL
  auto packet =
      test::position_packet(5'000'000, 2, bare + std::string(512 - 0xCE - bare.size(), '$'), 0);
  EXPECT_TRUE(parse_position_packet(packet.bytes)->synchronized());
  packet = test::position_packet(5'000'000, 2, std::string(512 - 0xCE, 'A'), 0);
  EXPECT_FALSE(parse_position_packet(packet.bytes)->synchronized());
}

TEST(ScanTimes, CrossTheHourUnbroken) {
  const auto packets = test::vlp16_packets(
      320, {.start_past_hour_s = 3599.8, .start_received_ns = kHour - 200'000'000});
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_EQ(out.counts.sensor_restarts, 0U);
  ASSERT_EQ(out.scans.size(), 4U);
  for (std::size_t i = 1; i < out.scans.size(); ++i)
    EXPECT_NEAR(static_cast<double>(out.scans[i].start_ns - out.scans[i - 1].start_ns), 1e8, 6e4);
  EXPECT_NEAR(static_cast<double>(out.scans[0].start_ns - (kHour - 200'000'000)), 5.5e6, 1e5);
}

TEST(ScanTimes, SayWhichClockIsInForce) {
  auto packets = test::vlp16_packets(320, {.start_received_ns = kHour + 1000 * kSecondNs});
  EXPECT_EQ(build(packets).scans[3].clock, ClockSource::host);
  packets.insert(packets.begin() + 100,
                 test::position_packet(1'000'132'000, 2, test::gprmc(9, 16, 40, 14, 5, 2024),
                                       packets[100].received_ns));
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.position_packets, 1U);
  EXPECT_EQ(out.scans[1].clock, ClockSource::host);
  EXPECT_EQ(out.scans[2].clock, ClockSource::gps);
}

TEST(ScanTimes, AStepOfTheHostClockBendsNoScan) {
  auto packets = test::vlp16_packets(320, {.start_received_ns = kHour + 1000 * kSecondNs});
  for (std::size_t i = 130; i < packets.size(); ++i) packets[i].received_ns += 500 * kSecondNs;
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.sensor_restarts, 0U);
  ASSERT_EQ(out.scans.size(), 4U);
  for (const Scan& scan : out.scans) {
    EXPECT_TRUE(scan.complete);
    EXPECT_NEAR(static_cast<double>(scan.end_ns - scan.start_ns), 1e8, 1e5);
  }
}

}  // namespace
}  // namespace lilo
