// SPDX-License-Identifier: BSD-3-Clause
// The 512-byte position packet and its NMEA sentence.
#include "drivers/position_packet.hpp"
#include "tests/fuzz/fuzz_input.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = lilo::fuzz::bytes_of(data, size);
  lilo::parse_position_packet(bytes);
  std::vector<std::byte> packet(512);
  std::copy_n(bytes.begin(), std::min<std::size_t>(size, 512 - 0xC6), packet.begin() + 0xC6);
  const auto parsed = lilo::parse_position_packet(packet);
  if (parsed && parsed->gps)  // years 2000 to 2099
    lilo::fuzz::require(parsed->gps->utc_ns >= 946'684'800'000'000'000 &&
                        parsed->gps->utc_ns <= 4'102'444'800'000'000'000);
  lilo::parse_gprmc({reinterpret_cast<const char*>(data), size});
  return 0;
}
