#pragma once

#include "drivers/hdl64e_calibration.hpp"

#include <string>

namespace lilo {

/// Velodyne's db.xml, a boost::serialization archive: degrees and centimetres. Throws DriverError;
/// `name` is what the message calls the file.
Hdl64eCalibration read_calibration_xml(const std::string& name, const std::string& text);

/// Either form, from memory; checked for plausibility. Throws DriverError.
Hdl64eCalibration parse_calibration(const std::string& name, const std::string& text);

}  // namespace lilo
