// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/kitti_times.hpp"

#include "drivers/packet_source.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace lilo {
namespace {

constexpr double kNsPerSecond = 1e9;

/// Takes a number off the front of the text.
template <typename Number>
std::optional<Number> take(std::string_view& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool take(std::string_view& text, char expected) {
  if (text.empty() || text.front() != expected) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<std::int64_t> from_seconds(std::string_view text) {
  const auto seconds = take<double>(text);
  if (!seconds || !text.empty() || !(std::abs(*seconds) < 1e10)) return std::nullopt;
  return std::llround(*seconds * kNsPerSecond);
}

/// "2011-09-26 13:02:25.594360375".
std::optional<std::int64_t> from_date(std::string_view text) {
  using namespace std::chrono;
  std::array<int, 5> part{};  // year, month, day, hour, minute
  constexpr std::string_view kBehind = "-- ::";
  for (std::size_t k = 0; k < part.size(); ++k) {
    const auto value = take<unsigned>(text);
    if (!value || *value > 9999 || !take(text, kBehind[k])) return std::nullopt;
    part[k] = static_cast<int>(*value);
  }
  // All digits of the nanoseconds: a double of seconds since 1970 would not hold them.
  const auto second = take<unsigned>(text);
  const auto fraction = text.empty() ? 0.0 : take<double>(text);
  const year_month_day date{year{part[0]}, month{static_cast<unsigned>(part[1])},
                            day{static_cast<unsigned>(part[2])}};
  if (!second || *second > 60 || !fraction || !(*fraction >= 0.0 && *fraction < 1.0) ||
      !text.empty() || !date.ok() || part[3] > 23 || part[4] > 59) {
    return std::nullopt;
  }
  const nanoseconds whole =
      sys_days{date}.time_since_epoch() + hours{part[3]} + minutes{part[4]} + seconds{*second};
  return whole.count() + std::llround(*fraction * kNsPerSecond);
}

}  // namespace

KittiTimes read_kitti_times(const std::filesystem::path& file) {
  KittiTimes times_ns;
  std::ifstream in(file);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos) {
      times_ns.emplace_back();
      continue;
    }
    const std::size_t end = line.find_last_not_of(" \t\r") + 1;
    const std::string_view text = std::string_view(line).substr(begin, end - begin);
    auto time_ns = from_seconds(text);
    if (!time_ns) time_ns = from_date(text);
    if (!time_ns) {
      throw DriverError(file.string() + ":" + std::to_string(number) +
                        ": expected a time in seconds, or date and time, found \"" + line + "\"");
    }
    times_ns.push_back(time_ns);
  }
  return times_ns;
}

}  // namespace lilo
