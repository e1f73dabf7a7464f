#pragma once

#include "drivers/scan_source.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/trajectory.hpp"

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

}  // namespace lilo::test
