// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/calibration.hpp"

#include <string>

namespace lilo {

/// Velodyne's db.xml, a boost::serialization archive: degrees and centimetres. Throws DriverError;
/// `name` is what the message calls the file.
Calibration read_calibration_xml(const std::string& name, const std::string& text);

/// Throws DriverError unless a sensor has so many lasers.
void check_laser_count(const std::string& name, std::size_t count);

/// Either form, from memory; checked for plausibility. Throws DriverError.
Calibration parse_calibration(const std::string& name, const std::string& text);

}  // namespace lilo
