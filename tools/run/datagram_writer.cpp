// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/datagram_writer.hpp"

#include "daemon/base_frame.hpp"
#include "tools/clock.hpp"

namespace lilo {

DatagramWriter::DatagramWriter(const PublishConfig& publish)
    : message_{new_session(), publish.frame_id, publish.child_frame_id},
      T_base_sensor_(to_pose(publish.T_base_sensor)),
      mounted_(!is_identity(publish.T_base_sensor)),
      last_ns_(monotonic_ns()) {}

Estimate DatagramWriter::placed(const Estimate& estimate) const {
  return mounted_ ? in_base_frame(estimate, T_base_sensor_) : estimate;
}

std::string_view DatagramWriter::pose(const Scan& scan, const Estimate& estimate) {
  if (estimate.restarts != restarts_) {
    renew_session(message_.session);
    seq_ = 0;
  }
  restarts_ = estimate.restarts;
  stamp_ns_ = estimate.stamp_ns;
  const PoseReport report{.estimate = placed(estimate),
                          .seq = seq_++,
                          .last_packet_ns = last_ns_,
                          .packets = scan.packets};
  const std::string_view line = write_pose(message_, report, monotonic_ns(), json_);
  last_ns_ = monotonic_ns();
  return line;
}

void DatagramWriter::points(const Odometry& odometry, std::size_t most_of_scan,
                            std::size_t most_of_map,
                            const std::function<void(std::string_view)>& take) {
  odometry.aligned_points(most_of_scan, points_m_);
  write_all(PointSet::scan, take);
  odometry.mapped_points(most_of_map, points_m_);
  write_all(PointSet::map, take);
}

void DatagramWriter::write_all(PointSet set, const std::function<void(std::string_view)>& take) {
  if (mounted_) {
    for (Eigen::Vector3f& p_m : points_m_)
      p_m = (T_base_sensor_ * p_m.cast<double>()).cast<float>();
  }
  const PointsContext context{message_.session, stamp_ns_, seq_ - 1};
  for (std::size_t k = 0; k < points_datagrams(points_m_.size()); ++k)
    take(write_points(context, set, points_m_, k, json_));
}

}  // namespace lilo
