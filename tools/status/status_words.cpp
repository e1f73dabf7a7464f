// SPDX-License-Identifier: BSD-3-Clause
#include "tools/status/status_words.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <ctime>
#include <numbers>

namespace lilo {
namespace {

using nlohmann::json;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kDegrees = 180.0 / std::numbers::pi;

double length(const json& vector) {
  return std::hypot(vector.value("x", 0.0), vector.value("y", 0.0), vector.value("z", 0.0));
}

}  // namespace

std::string duration_words(double seconds) {
  const auto all = static_cast<std::int64_t>(seconds);
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  if (all < 60) return fmt::format("{} s", all);
  if (all < 3600) return fmt::format("{} min {} s", all / 60, all % 60);
  if (all < 86400) return fmt::format("{} h {} min", all / 3600, all / 60 % 60);
  return fmt::format("{} d {} h", all / 86400, all / 3600 % 24);
}

std::string time_words(std::int64_t utc_ns) {
  const std::time_t seconds = utc_ns / kSecond;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03d}", utc, utc_ns % kSecond / 1'000'000);
}

std::string clock_words(std::string_view clock) {
  if (clock == "gps") return "GPS";
  if (clock == "host") return "this computer's clock";
  return std::string(clock.empty() ? "an unknown clock" : clock);
}

std::string position_words(const PoseMessage& message) {
  const Eigen::Vector3d& t = message.pose.pose.translation_m;
  std::string text =
      fmt::format("x {:.3f}, y {:.3f}, z {:.3f} m", rounded(t.x()), rounded(t.y()), rounded(t.z()));
  if (message.deviation) text += fmt::format(", +- {:.3f} m", message.deviation->position_m);
  return text;
}

std::string rotation_words(const PoseMessage& message) {
  const Eigen::Vector3d deg = roll_pitch_yaw_deg(message.pose.pose.rotation);
  std::string text = fmt::format("roll {:.2f}, pitch {:.2f}, yaw {:.2f} deg", rounded(deg.x()),
                                 rounded(deg.y()), rounded(deg.z()));
  if (message.deviation)
    text += fmt::format(", +- {:.2f} deg", message.deviation->rotation_rad * kDegrees);
  return text;
}

std::string speed_words(const json& twist) {
  return fmt::format("{:.2f} m/s, turning {:.1f} deg/s",
                     length(twist.value("linear", json::object())),
                     length(twist.value("angular", json::object())) * kDegrees);
}

std::string weak_words(const PoseMessage& message) {
  constexpr std::array<const char*, 6> kAxes{"x", "y", "z", "rx", "ry", "rz"};
  std::string text;
  for (const PoseMessage::Weak& weak : message.weak) {
    text += text.empty() ? "" : ", ";
    text += fmt::format("{} {:.0f} %", kAxes[static_cast<std::size_t>(weak.axis)],
                        100.0 * weak.from_scan);
  }
  return text;
}

}  // namespace lilo
