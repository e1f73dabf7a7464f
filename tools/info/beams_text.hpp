// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_estimate.hpp"

#include <string>

namespace lilo {

/// Whether a file is one of lilod's beams: its name ends in .yaml.
bool is_beams_file(const std::string& path);

std::string to_json(const BeamEstimate& beams);

/// A row for each ring, in degrees, and one for the encoder.
std::string to_text(const BeamEstimate& beams);

}  // namespace lilo
