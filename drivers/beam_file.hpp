// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_estimate.hpp"

#include <string>

/// What lilod has found of a sensor's beams, as a YAML file in its state directory.
namespace lilo {

/// Where it is kept.
std::string kept_beams_path(const std::string& state_directory);

/// The file's text, in milliradians.
std::string beams_yaml(const BeamEstimate& beams);

/// Throws DriverError naming file, line and key. A value beyond 1 deg is no error of a beam.
BeamEstimate read_beams(const std::string& path);

}  // namespace lilo
