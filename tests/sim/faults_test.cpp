// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/faults.hpp"

#include "tools/sim/encoder.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace lilo::sim {
namespace {

constexpr int kPackets = 20000;
constexpr std::int64_t kPeriod_ns = 1'327'104;

/// Packets that carry their own number where the stamp is.
Packet numbered(std::uint32_t number) {
  Packet packet{number * kPeriod_ns, kDataPort, std::vector<std::uint8_t>(1206, 0)};
  put_u16(packet.payload, 0, 0xEEFF);
  put_u32(packet.payload, 1200, number);
  return packet;
}

struct Arrived {
  std::vector<std::uint32_t> numbers;  ///< of undamaged packets, in order of arrival
  int foreign = 0;
  FaultCounts counts;
  std::size_t listed_losses = 0;
};

Arrived send_all(const FaultOptions& options) {
  Arrived arrived;
  Faults faults(options, 3, [&](const Packet& packet) {
    const auto& p = packet.payload;
    bool good = p.size() == 1206 && p[0] == 0xFF && p[1] == 0xEE && p[700] == 0;
    for (std::size_t k = 302; good && k < 304; ++k) good = p[k] == 0;
    if (!good) {
      ++arrived.foreign;
      return;
    }
    arrived.numbers.push_back(static_cast<std::uint32_t>(p[1200] | p[1201] << 8 | p[1202] << 16));
  });
  for (std::uint32_t k = 0; k < kPackets; ++k) faults.send(numbered(k));
  faults.flush();
  arrived.counts = faults.counts();
  arrived.listed_losses = faults.lost_ns().size();
  return arrived;
}

TEST(Faults, NothingIsTouchedWithoutFaults) {
  const Arrived arrived = send_all({});
  ASSERT_EQ(arrived.numbers.size(), static_cast<std::size_t>(kPackets));
  for (std::uint32_t k = 0; k < kPackets; ++k) ASSERT_EQ(arrived.numbers[k], k);
}

TEST(Faults, CountsAreWhatHappened) {
  FaultOptions options;
  options.loss = 0.02;
  options.bursts_per_minute = 20.0;
  options.burst_packets = 30;
  options.duplicates = 0.01;
  options.reorder = 0.01;
  options.garbage = 0.01;
  const Arrived arrived = send_all(options);
  std::map<std::uint32_t, int> times;
  std::uint64_t late = 0, twice = 0;
  std::uint32_t highest = 0;
  for (const std::uint32_t n : arrived.numbers) {
    if (++times[n] == 2) ++twice;
    if (n < highest && times[n] == 1) ++late;
    highest = std::max(highest, n);
  }
  EXPECT_EQ(arrived.counts.lost, kPackets - times.size());
  EXPECT_EQ(arrived.listed_losses, arrived.counts.lost);
  EXPECT_EQ(arrived.counts.duplicates, twice);
  EXPECT_EQ(arrived.counts.reordered, late);
  EXPECT_EQ(arrived.counts.garbage, static_cast<std::uint64_t>(arrived.foreign));
  EXPECT_NEAR(static_cast<double>(twice), 200.0, 60.0);
  EXPECT_NEAR(static_cast<double>(late), 200.0, 60.0);
  EXPECT_NEAR(arrived.foreign, 200.0, 60.0);
  EXPECT_GT(arrived.counts.lost, 450U);  // 400 alone and 26.5 s of bursts
}

TEST(Faults, RestartIsOneGap) {
  FaultOptions options;
  options.restart_at_s = 5.0;
  options.restart_gap_s = 2.0;
  const Arrived arrived = send_all(options);
  int gaps = 0;
  for (std::size_t k = 1; k < arrived.numbers.size(); ++k) {
    const std::uint32_t step = arrived.numbers[k] - arrived.numbers[k - 1];
    if (step == 1) continue;
    ++gaps;
    EXPECT_NEAR(step * kPeriod_ns * 1e-9, 2.0, 0.004);
    EXPECT_NEAR(arrived.numbers[k - 1] * kPeriod_ns * 1e-9, 5.0, 0.002);
  }
  EXPECT_EQ(gaps, 1);
}

TEST(SensorClock, WrapsAtTheHourOrALittleLater) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t start = 1'700'002'799LL * kSecond;  // one second before an hour
  const SensorClock sharp(start), late(start, 0.5);
  EXPECT_EQ(sharp.stamp_us(0), 3'599'000'000U);
  EXPECT_EQ(sharp.stamp_us(kSecond + 250'000'000), 250'000U);
  EXPECT_EQ(late.stamp_us(kSecond + 250'000'000), 3'600'250'000U);
  EXPECT_EQ(late.stamp_us(kSecond + 500'000'000), 500'000U);
  SensorClock free(0);
  free.restart(7 * kSecond);
  EXPECT_EQ(free.stamp_us(7 * kSecond + 1'500), 1U);
}

}  // namespace
}  // namespace lilo::sim
