// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>

/// Counts and times of a message that anybody may have sent. json::get() casts whatever number
/// stands there, and the cast of one out of range is undefined. All throw json::exception.
namespace lilo {

/// The latest time of a message, in the year 2255. In nanoseconds it still fits.
inline constexpr std::uint64_t kLatest_s = 9'000'000'000;

inline std::uint64_t count_from(const nlohmann::json& value) {
  using nlohmann::json;
  if (!value.is_number_integer() || (!value.is_number_unsigned() && value.get<std::int64_t>() < 0))
    throw json::type_error::create(302, "expected a whole number from 0", &value);
  return value.get<std::uint64_t>();
}

/// 0 where it is missing: older daemons say less.
inline std::uint64_t count_in(const nlohmann::json& object, const char* name) {
  return object.contains(name) ? count_from(object[name]) : 0;
}

/// Of {"sec": ..., "nsec": ...}.
inline std::int64_t stamp_ns_from(const nlohmann::json& stamp) {
  using nlohmann::json;
  constexpr std::uint64_t kSecond_ns = 1'000'000'000;
  const std::uint64_t sec = count_from(stamp.at("sec")), nsec = count_from(stamp.at("nsec"));
  if (sec > kLatest_s || nsec >= kSecond_ns)
    throw json::out_of_range::create(406, "expected a stamp up to 2255", &stamp);
  return static_cast<std::int64_t>(sec * kSecond_ns + nsec);
}

/// Of "timestamp", in seconds; a double holds whole microseconds.
inline std::int64_t timestamp_ns_from(const nlohmann::json& timestamp_s) {
  using nlohmann::json;
  const auto seconds = timestamp_s.get<double>();
  if (!(std::abs(seconds) <= static_cast<double>(kLatest_s)))
    throw json::out_of_range::create(406, "expected a timestamp up to 2255", &timestamp_s);
  return std::llround(seconds * 1e6) * 1000;
}

}  // namespace lilo
