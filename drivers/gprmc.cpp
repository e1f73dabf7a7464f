// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/gprmc.hpp"

#include <array>
#include <charconv>
#include <chrono>

namespace lilo {
namespace {

constexpr std::size_t kFields = 10;  // up to the date

// Two digits in [low, high], or -1.
int two_digits(std::string_view text, std::size_t at, int low, int high) {
  if (text.size() < at + 2) return -1;
  const char a = text[at], b = text[at + 1];
  if (a < '0' || a > '9' || b < '0' || b > '9') return -1;
  const int value = (a - '0') * 10 + (b - '0');
  return value < low || value > high ? -1 : value;
}

bool checksum_holds(std::string_view body, std::string_view sum) {
  unsigned stated = 0;
  if (sum.size() < 2) return false;
  const auto [end, error] = std::from_chars(sum.data(), sum.data() + 2, stated, 16);
  if (error != std::errc{} || end != sum.data() + 2) return false;
  unsigned found = 0;
  for (const char c : body) found ^= static_cast<unsigned char>(c);
  return found == stated;
}

std::array<std::string_view, kFields> split(std::string_view body) {
  std::array<std::string_view, kFields> fields;
  for (auto& field : fields) {
    const std::size_t comma = body.find(',');
    field = body.substr(0, comma);
    if (comma == std::string_view::npos) break;
    body.remove_prefix(comma + 1);
  }
  return fields;
}

}  // namespace

std::int64_t utc_seconds(int year, int month, int day, int hour, int minute, int second) {
  const std::chrono::sys_days date = std::chrono::year(year) /
                                     std::chrono::month(static_cast<unsigned>(month)) /
                                     std::chrono::day(static_cast<unsigned>(day));
  const std::int64_t days = date.time_since_epoch().count();
  return ((days * 24 + hour) * 60 + minute) * 60 + second;
}

std::optional<GpsTime> parse_gprmc(std::string_view text) {
  text = text.substr(0, text.find_first_of(std::string_view("\r\n\0", 3)));
  if (text.substr(0, 7) != "$GPRMC," && text.substr(0, 7) != "$GNRMC,") return std::nullopt;
  std::string_view body = text.substr(1);
  if (const std::size_t star = body.find('*'); star != std::string_view::npos) {
    if (!checksum_holds(body.substr(0, star), body.substr(star + 1))) return std::nullopt;
    body = body.substr(0, star);
  }
  const auto fields = split(body);
  const std::string_view time = fields[1], date = fields[9];
  const int hour = two_digits(time, 0, 0, 23), minute = two_digits(time, 2, 0, 59);
  const int second = two_digits(time, 4, 0, 60);  // 60: a leap second
  const int day = two_digits(date, 0, 1, 31), month = two_digits(date, 2, 1, 12);
  const int year = two_digits(date, 4, 0, 99);
  if (hour < 0 || minute < 0 || second < 0 || day < 0 || month < 0 || year < 0) return std::nullopt;
  return GpsTime{
      .utc_ns = utc_seconds(2000 + year, month, day, hour, minute, second) * 1'000'000'000,
      .valid = fields[2] == "A"};
}

}  // namespace lilo
