// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/run/datagram_writer.hpp"

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
  std::string path_;
  std::ofstream file_;
  DatagramWriter writer_;
};

}  // namespace lilo
