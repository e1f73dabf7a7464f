// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/health.hpp"
#include "daemon/pipeline.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lilo {

/// Tells the journal what befalls the sensor, the odometry and the session: one line when something
/// changes, once a second at most, with the cause where it is known. What log_event() refuses for
/// being too much is told later, as it is then. One thread, the publisher's; note() allocates
/// nothing.
class Story {
 public:
  /// Every pose, as the worker reports it.
  void note(const PoseReport& report);
  /// The map was given up, or a client asked for a reset.
  void session_replaced(const std::string& before, const std::string& now, bool by_reset);
  /// Once a second.
  void second(const Health& h);

 private:
  /// Poses of the second now running.
  struct Poses {
    int all = 0, initializing = 0, degraded = 0, lost = 0, partial = 0, doubtful = 0, uncertain = 0,
        unconfirmed = 0;
    double weakest_from_scan = 2.0;  // 2: no direction was weak
    int weakest_axis = 0;
  };
  /// The place was found again after poses that were lost.
  struct Found {
    int lost_poses = 0;
    double distance_m = 0.0, angle_rad = 0.0;  // from where the prediction was
  };

  void note_relocalization(const PoseReport& report);
  void tell_sensor(const Health& h);
  void tell_tilt(const Health& h);
  void tell_wrong_sensor(const Health& h);
  void tell_second_sensor(const Health& h);
  void tell_flow(const Health& h);
  void tell_tracking();
  void tell_better(TrackingStatus now);
  void tell_calibration(const SensorStatus& sensor);
  void tell_clients(const Health& h);
  void tell_clock(const Health& h);
  void tell_faults(const Health& h);
  [[nodiscard]] TrackingStatus worst() const;
  [[nodiscard]] std::string why_degraded() const;

  Poses poses_;
  Found found_;
  Pose last_, before_last_;  // T_odom_sensor of the last poses
  int lost_poses_ = 0;       // in a row
  std::uint64_t resets_ = 0;
  std::uint32_t restarts_ = 0;

  // What was told last, and since when it has been so.
  SensorStatus sensor_;
  double tilt_deg_ = 0.0;
  RefusedSensor wrong_sensor_;  // none: nothing of it was told
  bool second_sensor_ = false;
  Flow flow_ = Flow::all;
  Flow flow_seen_ = Flow::all;
  std::int64_t flow_since_ns_ = 0;
  TrackingStatus tracking_ = TrackingStatus::initializing;
  std::int64_t bad_since_ns_ = 0;
  int calm_s_ = 0;  // seconds without a pose worse than tracking
  CalibrationOrigin calibration_ = CalibrationOrigin::none;
  std::uint64_t clients_refused_ = 0, clock_steps_ = 0;
  FaultCounts faults_;
  std::int64_t faults_told_ns_ = -10'000'000'000;
};

}  // namespace lilo
