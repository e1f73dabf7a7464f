#include "tools/run/pose_log.hpp"

#include "daemon/base_frame.hpp"
#include "tools/clock.hpp"
#include "tools/text_file.hpp"

#include <utility>

namespace lilo {

PoseLog::PoseLog(std::string path, const PublishConfig& publish)
    : path_(std::move(path)),
      file_(create_text(path_)),
      message_{new_session(), publish.frame_id, publish.child_frame_id},
      T_base_sensor_(to_pose(publish.T_base_sensor)),
      mounted_(!is_identity(publish.T_base_sensor)),
      last_ns_(monotonic_ns()) {}

Estimate PoseLog::placed(const Estimate& estimate) const {
  return mounted_ ? in_base_frame(estimate, T_base_sensor_) : estimate;
}

void PoseLog::add(const Scan& scan, const Estimate& estimate) {
  if (estimate.restarts != restarts_) {
    renew_session(message_.session);
    seq_ = 0;
  }
  restarts_ = estimate.restarts;
  const PoseReport report{.estimate = placed(estimate),
                          .seq = seq_++,
                          .last_packet_ns = last_ns_,
                          .packets = scan.packets};
  const std::int64_t now_ns = monotonic_ns();
  const std::string_view line = write_pose(message_, report, now_ns, json_);
  if (!line.empty()) file_ << line << '\n';
  last_ns_ = monotonic_ns();
}

void PoseLog::finish() { finish_text(file_, path_); }

}  // namespace lilo
