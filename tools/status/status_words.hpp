// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/listen/pose_message.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace lilo {

/// "12 s", "3 min 12 s", "2 h 5 min", "3 d 4 h".
std::string duration_words(double seconds);
/// "2026-11-23 09:31:12.345" of UTC.
std::string time_words(std::int64_t utc_ns);
/// What health calls a clock, for people.
std::string clock_words(std::string_view clock);

/// "x 1.250 y -0.031 z 0.004 m, +- 0.012 m" (1 sigma).
std::string position_words(const PoseMessage& message);
/// Roll, pitch and yaw about the parent's fixed axes, likewise.
std::string rotation_words(const PoseMessage& message);
/// "8.10 m/s, turning 1.2 deg/s" of a pose's twist.
std::string speed_words(const nlohmann::json& twist);
/// "x 3 %, rz 40 %", the part of each that came from the scan; empty when there are none.
std::string weak_words(const PoseMessage& message);

}  // namespace lilo
