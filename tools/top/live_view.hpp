// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/status/status_report.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace lilo {

/// What `lilo top` shows: the state, how late the last poses were, and what changed since it
/// looks.
class LiveView {
 public:
  explicit LiveView(std::string address, std::string software);

  /// A datagram of the daemon, and the time it came (UTC).
  void take(const nlohmann::json& message, std::int64_t now_ns);
  /// The daemon has said nothing for so long.
  void silence(double seconds, std::int64_t now_ns);

  /// At most `rows` lines of at most `columns` characters.
  [[nodiscard]] std::string text(std::size_t rows, std::size_t columns, const Paint& paint) const;

 private:
  void take_health(const nlohmann::json& message, std::int64_t now_ns);
  void take_pose(const nlohmann::json& message, std::int64_t now_ns);
  void note(std::int64_t now_ns, Colour colour, const std::string& what);
  void note_session(const std::string& session, std::int64_t now_ns);
  void note_status(const std::string& status, std::int64_t now_ns);

  StatusReport report_;
  std::string session_, status_;
  nlohmann::json complaints_ = nlohmann::json::array();
  std::deque<double> latencies_ms_;
  std::deque<StatusRow> events_;  // the newest first; label is the time
  double silent_s_ = 0.0;
  bool silence_noted_ = false;
};

/// Values as a row of bars, from 0 to the largest: the last `columns` of them.
std::string bars(const std::deque<double>& values, std::size_t columns);

}  // namespace lilo
