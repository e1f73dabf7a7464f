// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/position_packet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace lilo::sim {
namespace {

std::string with_checksum(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}\r\n", body, sum);
}

std::string rmc_sentence(std::int64_t utc_s) {
  using namespace std::chrono;
  const sys_seconds time{seconds(utc_s)};
  const sys_days day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(time - day);
  return with_checksum(fmt::format(
      "GPRMC,{:02}{:02}{:02},A,4807.0380,N,01131.0000,E,000.0,000.0,{:02}{:02}{:02},003.1,W",
      clock.hours().count(), clock.minutes().count(), clock.seconds().count(),
      static_cast<unsigned>(date.day()), static_cast<unsigned>(date.month()),
      static_cast<int>(date.year()) % 100));
}

}  // namespace

Packet encode_position(std::int64_t time_ns, std::int64_t start_utc_ns, std::uint32_t stamp_us) {
  constexpr std::int64_t kSentenceDelay_ns = 150'000'000;
  Packet packet{time_ns, kPositionPort, std::vector<std::uint8_t>(512, 0)};
  put_u32(packet.payload, 0xC6, stamp_us);
  packet.payload[0xCA] = 2;
  const std::string sentence =
      rmc_sentence((start_utc_ns + time_ns - kSentenceDelay_ns) / 1'000'000'000);
  std::copy(sentence.begin(), sentence.end(), packet.payload.begin() + 0xCE);
  return packet;
}

}  // namespace lilo::sim
