// SPDX-License-Identifier: BSD-3-Clause
// Calibration files: db.xml and the YAML form.
#include "drivers/calibration_xml.hpp"
#include "drivers/packet_source.hpp"
#include "tests/fuzz/fuzz_input.hpp"

#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string text(reinterpret_cast<const char*>(data), size);
    lilo::fuzz::require(implausible(lilo::parse_calibration("input", text)).empty());
  } catch (const lilo::DriverError&) {  // the one way to refuse
  }
  return 0;
}
