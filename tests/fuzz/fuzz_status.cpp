// SPDX-License-Identifier: BSD-3-Clause
// The status bytes of an HDL-64E: [type][value] pairs; a type of 0 is a loss of `value` packets.
#include "drivers/hdl64e_status.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lilo::Hdl64eStatus;
  Hdl64eStatus status;
  std::uint32_t lost = 0;
  for (std::size_t i = 0; i + 1 < size; i += 2) {
    if (data[i] == 0) {
      lost += data[i + 1];
      continue;
    }
    const auto table = status.see(data[i], data[i + 1], lost, size % 2 == 0);
    if (table != Hdl64eStatus::Table::incomplete && table != Hdl64eStatus::Table::refused)
      lilo::fuzz::require(lilo::implausible(status.calibration()).empty());
    status.take_gps_utc_ns();
    lost = 0;
  }
  return 0;
}
