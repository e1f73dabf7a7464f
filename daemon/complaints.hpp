// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/health.hpp"

#include <boost/container/static_vector.hpp>

#include <array>
#include <cstdint>
#include <string_view>

namespace lilo {

/// What keeps `health` from being good.
enum class Complaint : std::uint8_t {
  sensor_silent,
  no_scans,
  no_poses,
  waiting_for_calibration,
  lost,
  degraded,
  wrong_sensor,
  second_sensor,
  packets_lost,
  kernel_dropped,
  malformed_packets,
  receive_errors,
  sensor_restarted,
  scans_dropped,
  map_full,
  poses_not_sent,
  send_errors,
  clock_stepped,
  realtime_refused,
  config_bad,
  metrics_not_written,
};
inline constexpr std::size_t kComplaintCount = 21;

/// In the order of the enumeration.
using Complaints = boost::container::static_vector<Complaint, kComplaintCount>;

/// What is not well now; what happened again and again is told for ten seconds after the last time.
/// Empty when all is well.
Complaints complaints(const Health& health);

/// What is said of it while it goes on.
Complaint complaint_of(Fault fault);
/// Of the counts in `health`, those that are faults.
FaultCounts fault_totals(const Health& health);

/// For people: "packets lost".
std::string_view words(Complaint complaint);
/// The same with what is known of it, and no allocation: "packets of a VLP-32C (product byte 0x28)
/// refused, configured is VLP-16: set sensor.model". May live in `buffer`.
using WordsBuffer = std::array<char, 128>;
std::string_view words(Complaint complaint, const Health& health, WordsBuffer& buffer);
/// For programs: "packets_lost".
std::string_view slug(Complaint complaint);

}  // namespace lilo
