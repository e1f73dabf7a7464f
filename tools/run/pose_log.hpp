#pragma once

#include "config/config.hpp"
#include "core/estimate.hpp"
#include "core/scan.hpp"
#include "daemon/pose_message.hpp"

#include <cstdint>
#include <fstream>
#include <string>

namespace lilo {

/// A file of the pose datagrams of daemon/PROTOCOL.md, a line each: what lilod would have sent had
/// it seen the same scans. `latency_ms` is the time one scan took, reading included: nothing
/// arrives here.
class PoseLog {
 public:
  /// `publish`: frames, and where the sensor is mounted. Throws std::runtime_error when the file
  /// cannot be written.
  PoseLog(std::string path, const PublishConfig& publish);

  void add(const Scan& scan, const Estimate& estimate);

  /// Writes what is still buffered. Throws std::runtime_error.
  void finish();

 private:
  [[nodiscard]] Estimate placed(const Estimate& estimate) const;

  std::string path_;
  std::ofstream file_;
  PoseMessageContext message_;
  Pose T_base_sensor_;
  bool mounted_;                // T_base_sensor is not the identity
  std::uint64_t seq_ = 0;       // of the next pose
  std::uint32_t restarts_ = 0;  // before the session
  std::int64_t last_ns_;        // monotonic: the pose before was written
  JsonWriter json_;
};

}  // namespace lilo
