// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>

/// Whole numbers of a message that anybody may have sent. json::get() casts whatever number stands
/// there, and the cast of one out of range is undefined. All throw json::exception.
namespace lilo {

inline std::uint64_t count_from(const nlohmann::json& value) {
  using nlohmann::json;
  if (!value.is_number_integer() || (!value.is_number_unsigned() && value.get<std::int64_t>() < 0))
    throw json::type_error::create(302, "expected a whole number from 0", &value);
  return value.get<std::uint64_t>();
}

/// Of {"sec": ..., "nsec": ...}, UTC; ns. Up to the year 2255.
inline std::int64_t stamp_ns_from(const nlohmann::json& stamp) {
  using nlohmann::json;
  constexpr std::uint64_t kLatest_s = 9'000'000'000, kSecond_ns = 1'000'000'000;
  const std::uint64_t sec = count_from(stamp.at("sec")), nsec = count_from(stamp.at("nsec"));
  if (sec > kLatest_s || nsec >= kSecond_ns)
    throw json::out_of_range::create(406, "expected a stamp up to 2255", &stamp);
  return static_cast<std::int64_t>(sec * kSecond_ns + nsec);
}

}  // namespace lilo
