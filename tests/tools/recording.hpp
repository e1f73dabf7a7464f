// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/scan_source.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/trajectory.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace lilo::test {

/// Scans of a simulated drive and where the sensor was at the end of each.
struct Recording {
  std::vector<Scan> scans;
  std::vector<Pose> truth;
};

/// A folder that `lilo sim` made.
inline Recording read_recording(const std::string& folder, const SensorConfig& sensor = {}) {
  Recording recording;
  const auto source = open_scans(folder + "/data.pcap", sensor);
  Scan scan;
  while (source->next(scan)) recording.scans.push_back(scan);
  for (const StampedPose& truth : read_trajectory(folder + "/gt_end.tum").poses) {
    recording.truth.push_back(truth.pose);
  }
  return recording;
}

inline Recording simulated(const sim::SimOptions& options) {
  const TemporaryFolder folder;
  sim::simulate(options, folder.path(), [](double) {});
  SensorConfig sensor;
  if (options.sensor.sensor != sim::Sensor::vlp16) {
    sensor.model = SensorModel::hdl64e;
    sensor.calibration_file = folder.path() + "/calibration.yaml";
  }
  return read_recording(folder.path(), sensor);
}

inline Recording recording_of(const char* world, const sim::MotionOptions& motion,
                              std::uint64_t seed = 3) {
  sim::SimOptions options;
  options.world = world;
  options.motion = motion;
  options.seed = seed;
  return simulated(options);
}

/// How far off the poses with one status were.
struct Poses {
  int count = 0;
  double worst_m = 0.0, worst_rad = 0.0;
  void add(const Pose& error) {
    ++count;
    worst_m = std::max(worst_m, error.translation_m.norm());
    worst_rad = std::max(worst_rad, so3_log(error.rotation).norm());
  }
};

}  // namespace lilo::test
