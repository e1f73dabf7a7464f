// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/truth_writer.hpp"

#include "core/pose.hpp"
#include "tools/sim/text_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

Pose pose_of(const Placement& placement) {
  return {Eigen::Quaterniond(placement.rotation).normalized(), placement.translation_m};
}

/// UTC seconds with six decimals, made from integers: a double of 1.7e9 s has 0.2 us steps.
std::string utc_text(std::int64_t start_utc_ns, double time_s) {
  const std::int64_t us =
      (start_utc_ns + static_cast<std::int64_t>(std::llround(time_s * 1e9)) + 500) / 1000;
  return fmt::format("{}.{:06}", us / 1'000'000, us % 1'000'000);
}

std::string tum_line(const std::string& stamp, const Pose& pose) {
  const auto& t = pose.translation_m;
  const auto& q = pose.rotation;
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  return fmt::format("{} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", stamp, t.x(), t.y(),
                     t.z(), sign * q.x(), sign * q.y(), sign * q.z(), sign * q.w());
}

std::string kitti_line(const Placement& pose) {
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double value = column < 3 ? pose.rotation(row, column) : pose.translation_m[row];
      line += fmt::format("{}{:.12e}", line.empty() ? "" : " ", value);
    }
  }
  return line + "\n";
}

Placement relative(const Placement& from, const Placement& to) {
  Placement result;
  result.rotation = from.rotation.transpose() * to.rotation;
  result.translation_m = from.rotation.transpose() * (to.translation_m - from.translation_m);
  return result;
}

PathSummary summarise(const SensorPath& path, double duration_s) {
  constexpr double kStep_s = 0.005;
  PathSummary summary;
  Vec3 last_velocity = Vec3::Zero();
  const int steps = static_cast<int>(duration_s / kStep_s);
  for (int k = 0; k < steps; ++k) {
    const Placement a = path.at(k * kStep_s), b = path.at((k + 1) * kStep_s);
    const Vec3 velocity = (b.translation_m - a.translation_m) / kStep_s;
    const double turn = so3_log(Eigen::Quaterniond(relative(a, b).rotation)).norm();
    summary.length_m += velocity.norm() * kStep_s;
    summary.max_speed_mps = std::max(summary.max_speed_mps, velocity.norm());
    if (k > 0) {
      const double change = (velocity - last_velocity).head<2>().norm() / kStep_s;
      summary.max_accel_mps2 = std::max(summary.max_accel_mps2, change);
    }
    summary.max_turn_rate_dps =
        std::max(summary.max_turn_rate_dps, turn / kStep_s * 180.0 / std::numbers::pi);
    last_velocity = velocity;
  }
  return summary;
}

}  // namespace

std::vector<Revolution> complete_revolutions(const Rotor& rotor, double end_s) {
  std::vector<Revolution> revolutions;
  double turn = std::ceil(rotor.azimuth_deg(0.0) / 360.0);
  double start = rotor.time_of(turn * 360.0, end_s);
  while (start >= 0.0) {
    const double middle = rotor.time_of(turn * 360.0 + 180.0, end_s);
    const double end = rotor.time_of((turn + 1.0) * 360.0, end_s);
    if (end < 0.0) break;
    revolutions.push_back({start, middle, end, 0});
    start = end;
    turn += 1.0;
  }
  return revolutions;
}

PathSummary write_truth(const std::string& folder, const SensorPath& path,
                        const std::vector<Revolution>& revolutions, std::int64_t start_utc_ns,
                        double duration_s) {
  const Placement origin = path.at(revolutions.empty() ? 0.0 : revolutions.front().start_s);
  const auto pose = [&](double time_s) { return relative(origin, path.at(time_s)); };
  std::string starts, ends, kitti, dense, table = "index,t_start,t_mid,t_end,points,gap\n";
  for (std::size_t k = 0; k < revolutions.size(); ++k) {
    const Revolution& r = revolutions[k];
    const std::string start = utc_text(start_utc_ns, r.start_s),
                      end = utc_text(start_utc_ns, r.end_s);
    starts += tum_line(start, pose_of(pose(r.start_s)));
    ends += tum_line(end, pose_of(pose(r.end_s)));
    kitti += kitti_line(pose(r.end_s));
    table += fmt::format("{},{},{},{},0,{}\n", k, start, utc_text(start_utc_ns, r.middle_s), end,
                         r.packets_lost);
  }
  for (int k = 0; k <= static_cast<int>(duration_s / 0.005 + 1e-6); ++k) {
    dense += tum_line(utc_text(start_utc_ns, 0.005 * k), pose_of(pose(0.005 * k)));
  }
  write_text(folder + "/gt_start.tum", starts);
  write_text(folder + "/gt_end.tum", ends);
  write_text(folder + "/gt_end_kitti.txt", kitti);
  write_text(folder + "/gt_dense.tum", dense);
  write_text(folder + "/revs.csv", table);
  write_text(folder + "/frame.txt", kitti_line(origin));
  PathSummary summary = summarise(path, duration_s);
  if (!revolutions.empty())
    summary.end_minus_start_m = pose(revolutions.back().end_s).translation_m;
  return summary;
}

}  // namespace lilo::sim
