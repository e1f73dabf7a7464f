// SPDX-License-Identifier: BSD-3-Clause
#include "tools/reset/reset_request.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <numbers>
#include <stdexcept>

namespace lilo {
namespace {

using nlohmann::json;

Eigen::Quaterniond rotation_from_deg(double roll, double pitch, double yaw) {
  constexpr double kRad = std::numbers::pi / 180.0;
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return AngleAxisd(yaw * kRad, Vector3d::UnitZ()) * AngleAxisd(pitch * kRad, Vector3d::UnitY()) *
         AngleAxisd(roll * kRad, Vector3d::UnitX());
}

}  // namespace

json reset_request(const std::vector<double>& pose) {
  if (pose.empty()) return {{"reset", json::object()}};
  if (pose.size() != 3 && pose.size() != 6) {
    throw std::runtime_error(fmt::format("--pose: expected 3 or 6 numbers, found {}", pose.size()));
  }
  const Eigen::Quaterniond q = pose.size() == 6 ? rotation_from_deg(pose[3], pose[4], pose[5])
                                                : Eigen::Quaterniond::Identity();
  const json position{{"x", pose[0]}, {"y", pose[1]}, {"z", pose[2]}};
  const json orientation{{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
  return {{"reset", {{"pose", {{"position", position}, {"orientation", orientation}}}}}};
}

}  // namespace lilo
