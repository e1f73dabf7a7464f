// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pose_message.hpp"

#include "daemon/message_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

namespace lilo {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

// Decimals: a tenth of a micrometre, and a quaternion good to 1e-9 rad.
constexpr int kMetreDecimals = 7, kQuaternionDecimals = 10, kVelocityDecimals = 6,
              kDirectionDecimals = 3;

void write_vector(JsonWriter& out, std::string_view key, const Eigen::Vector3d& v, int decimals) {
  out.begin_object(key);
  out.number("x", v.x(), decimals);
  out.number("y", v.y(), decimals);
  out.number("z", v.z(), decimals);
  out.end_object();
}

void write_stamp(JsonWriter& out, std::int64_t stamp_ns) {
  // Floor division: nsec is never negative, as in ROS.
  const std::int64_t nsec = (stamp_ns % kSecondNs + kSecondNs) % kSecondNs;
  out.begin_object("stamp");
  out.integer("sec", (stamp_ns - nsec) / kSecondNs);
  out.integer("nsec", nsec);
  out.end_object();
}

void write_orientation(JsonWriter& out, const Eigen::Quaterniond& q) {
  out.begin_object("orientation");
  out.number("x", q.x(), kQuaternionDecimals);
  out.number("y", q.y(), kQuaternionDecimals);
  out.number("z", q.z(), kQuaternionDecimals);
  out.number("w", q.w(), kQuaternionDecimals);
  out.end_object();
}

// A velocity that nobody measured is left out: zeros would be believed.
void write_twist(JsonWriter& out, const Estimate& estimate) {
  const bool measured =
      estimate.status == TrackingStatus::tracking || estimate.status == TrackingStatus::degraded;
  const Twist& twist = estimate.twist;
  if (!measured || !twist.linear_mps.allFinite() || !twist.angular_radps.allFinite()) return;
  out.begin_object("twist");
  write_vector(out, "linear", twist.linear_mps, kVelocityDecimals);
  write_vector(out, "angular", twist.angular_radps, kVelocityDecimals);
  out.end_object();
}

void write_covariance(JsonWriter& out, const Estimate& estimate) {
  if (!estimate.has_covariance || !estimate.covariance.allFinite()) return;
  out.begin_array("covariance");
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) out.scientific(estimate.covariance(row, column));
  }
  out.end_array();
}

void write_weak_direction(JsonWriter& out, const WeakDirection& weak) {
  out.begin_object("");
  out.begin_array("direction");
  for (const double component : weak.direction) out.number("", component, kDirectionDecimals);
  out.end_array();
  out.number("from_scan", weak.from_scan, kDirectionDecimals);
  out.end_object();
}

void write_weak_directions(JsonWriter& out, const Estimate& estimate) {
  const auto& all = estimate.weak_directions;
  const auto* const end = all.begin() + std::clamp(estimate.weak_count, 0, kMaxWeakDirections);
  const bool finite = std::all_of(all.begin(), end, [](const WeakDirection& weak) {
    return weak.direction.allFinite() && std::isfinite(weak.from_scan);
  });
  if (end == all.begin() || !finite) return;
  out.begin_array("weak_directions");
  std::for_each(all.begin(), end, [&](const WeakDirection& w) { write_weak_direction(out, w); });
  out.end_array();
}

/// What a datagram has room for; the covariance goes first.
enum class Optional { covariance_and_weak, weak_alone, none };

std::string_view write(const PoseMessageContext& context, const PoseReport& report,
                       std::int64_t now_ns, Optional optional, JsonWriter& out) {
  const Estimate& estimate = report.estimate;
  begin_message(out, estimate.stamp_ns, context.session);
  out.unsigned_integer("seq", report.seq);
  out.begin_object("pose");
  write_stamp(out, estimate.stamp_ns);
  out.text("frame_id", context.frame_id);
  out.text("child_frame_id", context.child_frame_id);
  out.text("status", to_string(estimate.status));
  write_vector(out, "position", estimate.T_odom_sensor.translation_m, kMetreDecimals);
  write_orientation(out, estimate.T_odom_sensor.rotation);
  write_twist(out, estimate);
  if (optional == Optional::covariance_and_weak) write_covariance(out, estimate);
  if (optional != Optional::none) write_weak_directions(out, estimate);
  out.number("latency_ms", static_cast<double>(now_ns - report.last_packet_ns) * 1e-6, 3);
  out.unsigned_integer("lost_packets", report.packets.lost);
  out.end_object();
  return out.finish();
}

}  // namespace

const char* to_string(TrackingStatus status) {
  switch (status) {
    case TrackingStatus::initializing:
      return "initializing";
    case TrackingStatus::tracking:
      return "tracking";
    case TrackingStatus::degraded:
      return "degraded";
    case TrackingStatus::lost:
      return "lost";
  }
  return "lost";
}

std::string new_session() {
  std::string session;
  renew_session(session);
  return session;
}

void renew_session(std::string& session) {
  std::random_device device;
  session.clear();
  fmt::format_to(std::back_inserter(session), "{:08x}{:08x}", device(), device());
}

std::string_view write_pose(const PoseMessageContext& context, const PoseReport& report,
                            std::int64_t now_ns, JsonWriter& out) {
  const Pose& pose = report.estimate.T_odom_sensor;
  if (!pose.translation_m.allFinite() || !pose.rotation.coeffs().allFinite()) return {};
  std::string_view text;
  for (const Optional optional :
       {Optional::covariance_and_weak, Optional::weak_alone, Optional::none}) {
    text = write(context, report, now_ns, optional, out);
    if (!text.empty()) break;
  }
  return text;
}

}  // namespace lilo
