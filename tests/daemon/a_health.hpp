// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/health.hpp"

namespace lilo {

/// The health of a VLP-16 that tracks and has lost three packets a moment ago.
inline Health a_health() {
  Health h;
  h.stamp_ns = 1'700'000'000'500'000'000;
  h.instance = "front";
  h.tracking = TrackingStatus::tracking;
  h.pose_age_s = 0.05;
  h.sensor.model = SensorModel::vlp16;
  h.sensor.sensor_ipv4 = 0xc0a801c9;
  h.sensor.rpm = 599.6;
  h.driver.data_packets = 1000;
  h.driver.packets_lost = 3;
  h.recent[Fault::packets_lost] = 3;
  h.latency_ms = {.p50 = 2.0, .p99 = 5.5, .max = 7.0};
  h.stages_ms[static_cast<std::size_t>(Stage::align)].p99 = 4.0;
  h.realtime.worker = {.policy = "SCHED_FIFO", .priority = 40, .cpus = "1"};
  return h;
}

}  // namespace lilo
