// SPDX-License-Identifier: BSD-3-Clause
#include "tools/listen/pose_message.hpp"

#include "daemon/message_head.hpp"
#include "tools/message_numbers.hpp"
#include "tools/terminal/printable.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <exception>
#include <numbers>

namespace lilo {
namespace {

using nlohmann::json;

constexpr std::int64_t kSecond = 1'000'000'000;

std::optional<Matrix6d> covariance_from(const json& pose) {
  if (!pose.contains("covariance")) return std::nullopt;
  const auto numbers = pose["covariance"].get<std::array<double, 36>>();
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(numbers.data());
}

std::optional<PoseMessage::Deviation> deviation_from(const std::optional<Matrix6d>& covariance) {
  if (!covariance) return std::nullopt;
  const Vector6d variances = covariance->diagonal();
  return PoseMessage::Deviation{std::sqrt(std::max(variances.head<3>().sum(), 0.0)),
                                std::sqrt(std::max(variances.tail<3>().sum(), 0.0))};
}

std::vector<PoseMessage::Weak> weak_from(const json& pose) {
  std::vector<PoseMessage::Weak> out;
  for (const json& weak : pose.value("weak_directions", json::array())) {
    const auto direction = weak.at("direction").get<std::array<double, 6>>();
    const auto* const largest =
        std::max_element(direction.begin(), direction.end(),
                         [](double a, double b) { return std::abs(a) < std::abs(b); });
    out.push_back({static_cast<int>(largest - direction.begin()), weak.at("from_scan")});
  }
  return out;
}

std::string_view major_of(std::string_view version) { return version.substr(0, version.find('.')); }

/// Of recordings that do not say, ours.
bool has_our_version(const json& object) {
  if (!object.contains("v")) return true;
  const json& v = object["v"];
  return v.is_string() && major_of(v.get_ref<const std::string&>()) == major_of(kProtocolVersion);
}

PoseMessage message_from(const json& object) {
  const json& pose = object.at("pose");
  const json& position = pose.at("position");
  const json& q = pose.at("orientation");
  const json& stamp = pose.at("stamp");
  PoseMessage message;
  message.seq = count_from(object.at("seq"));
  message.session = object.value("session", "");
  message.status = pose.value("status", "");
  message.pose.stamp_ns = stamp_ns_from(stamp);
  message.pose.pose.translation_m = {position.at("x").get<double>(), position.at("y").get<double>(),
                                     position.at("z").get<double>()};
  message.pose.pose.rotation = Eigen::Quaterniond(q.at("w").get<double>(), q.at("x").get<double>(),
                                                  q.at("y").get<double>(), q.at("z").get<double>())
                                   .normalized();
  message.covariance = covariance_from(pose);
  message.deviation = deviation_from(message.covariance);
  message.weak = weak_from(pose);
  return message;
}

std::string deviation_columns(const PoseMessage& message) {
  if (!message.deviation) return fmt::format("  {:>8}  {:>8}", "-", "-");
  return fmt::format("  {:8.3f}  {:8.3f}", message.deviation->position_m,
                     message.deviation->rotation_rad * 180.0 / std::numbers::pi);
}

/// "  weak: x 3 %, rz 40 %", the part of each that came from the scan.
std::string weak_column(const PoseMessage& message) {
  constexpr std::array<const char*, 6> kAxes{"x", "y", "z", "rx", "ry", "rz"};
  std::string out;
  for (const PoseMessage::Weak& weak : message.weak) {
    out += out.empty() ? "  weak: " : ", ";
    out += fmt::format("{} {:.0f} %", kAxes[static_cast<std::size_t>(weak.axis)],
                       100.0 * weak.from_scan);
  }
  return out;
}

std::string health_line(const json& object) {
  const json& health = object.at("health");
  const json& packets = health.at("packets");
  const json& latency_ms = health.at("latency_ms");
  std::string line = fmt::format(
      "         health           {:<12}  {:g} Hz, {} packets, {} lost, {} scans dropped, latency "
      "{:.1f} ms, p99 {:.1f} ms",
      health.at("status").get<std::string>(), health.at("rate_hz").get<double>(),
      count_from(packets.at("received")), count_from(packets.at("lost")),
      count_from(health.at("scans").at("dropped")), latency_ms.at("p50").get<double>(),
      latency_ms.at("p99").get<double>());
  for (const json& complaint : health.at("complaints")) {
    line += ", " + complaint.get<std::string>();
  }
  return printable(line) + "\n";
}

}  // namespace

MessageKind parse_message(std::string_view datagram, PoseMessage& message) {
  const json object = json::parse(datagram, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return MessageKind::malformed;
  if (!has_our_version(object)) return MessageKind::other_version;
  if (!object.contains("pose")) return MessageKind::other;
  try {
    message = message_from(object);
  } catch (const std::exception&) {  // of the parser, or of ours
    return MessageKind::malformed;
  }
  return MessageKind::pose;
}

Eigen::Vector3d roll_pitch_yaw_deg(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  const Eigen::Vector3d rad(std::atan2(r(2, 1), r(2, 2)),
                            std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2))),
                            std::atan2(r(1, 0), r(0, 0)));
  return rad * (180.0 / std::numbers::pi);
}

double rounded(double value) { return std::round(value * 1e3) / 1e3 + 0.0; }

std::string pose_heading() {
  return "       time UTC       seq  status              x m        y m        z m    roll deg  "
         "pitch deg    yaw deg     +- m    +- deg\n";
}

std::string pose_line(const PoseMessage& message) {
  const Eigen::Vector3d& t = message.pose.pose.translation_m;
  const Eigen::Vector3d angles = roll_pitch_yaw_deg(message.pose.pose.rotation);
  const std::int64_t stamp_ns = message.pose.stamp_ns;
  const std::time_t seconds = stamp_ns / kSecond;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format(
      "{:%H:%M:%S}.{:06d}  {:8d}  {:<12}  {:9.3f}  {:9.3f}  {:9.3f}   {:9.3f}  {:9.3f}  "
      "{:9.3f}{}{}\n",
      utc, stamp_ns % kSecond / 1000, message.seq, printable(message.status), rounded(t.x()),
      rounded(t.y()), rounded(t.z()), rounded(angles.x()), rounded(angles.y()), rounded(angles.z()),
      deviation_columns(message), weak_column(message));
}

std::string other_line(std::string_view datagram) {
  try {
    return health_line(json::parse(datagram));
  } catch (const json::exception&) {
    return printable(datagram) + "\n";
  }
}

}  // namespace lilo
