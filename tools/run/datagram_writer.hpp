// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "core/odometry.hpp"
#include "daemon/points_message.hpp"
#include "daemon/pose_message.hpp"

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace lilo {

/// The datagrams of daemon/PROTOCOL.md that lilod would have sent had it seen the same scans.
/// `latency_ms` is the time since the pose before: nothing arrives here.
class DatagramWriter {
 public:
  /// `publish`: frames, and where the sensor is mounted.
  explicit DatagramWriter(const PublishConfig& publish);

  /// Of the next scan. Lives until the next call; empty when the pose is no number.
  std::string_view pose(const Scan& scan, const Estimate& estimate);
  /// What the odometry saw with the last pose, at most so many points of each kind.
  void points(const Odometry& odometry, std::size_t most_of_scan, std::size_t most_of_map,
              const std::function<void(std::string_view)>& take);

 private:
  [[nodiscard]] Estimate placed(const Estimate& estimate) const;
  void write_all(PointSet set, const std::function<void(std::string_view)>& take);

  PoseMessageContext message_;
  Pose T_base_sensor_;
  bool mounted_;                // T_base_sensor is not the identity
  std::uint64_t seq_ = 0;       // of the next pose
  std::uint32_t restarts_ = 0;  // before the session
  std::int64_t stamp_ns_ = 0;   // of the last pose
  std::int64_t last_ns_;        // monotonic: the pose before was written
  JsonWriter json_;
  std::vector<Eigen::Vector3f> points_m_;
};

}  // namespace lilo
