// SPDX-License-Identifier: BSD-3-Clause
// A stream of packets of any size and content, at any time: [u8 kind][u16 ms or us][payload]. Kinds
// 0-3 are data packets, 4 a position packet, 5 one of 0-255 bytes.
#include "drivers/scan_builder.hpp"
#include "tests/fuzz/fuzz_input.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using lilo::fuzz::require;

// Whatever came in, a scan keeps its promises.
class Check final : public lilo::ScanSink {
 public:
  lilo::Scan& exchange(lilo::Scan& finished) override {
    std::int32_t before_ns = 0;
    require(finished.end_ns >= finished.start_ns);
    require(finished.packets.expected == finished.packets.received + finished.packets.lost);
    for (const lilo::Return& r : finished.returns) {
      require(r.t_ns >= before_ns && r.t_ns <= finished.end_ns - finished.start_ns);
      before_ns = r.t_ns;
      require(r.ring < finished.beams.ring_count);
      require(std::abs(r.azimuth_rad) < 3.1416F);
      require(std::isfinite(r.x_m) && std::isfinite(r.y_m) && std::isfinite(r.z_m));
    }
    finished.clear();
    return finished;
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lilo::Scan scan;
  Check check;
  lilo::ScanBuilder builder({}, scan, check);
  std::int64_t received_ns = 1'715'678'101'000'000'000;
  std::uint64_t fed = 0;
  while (size >= 3) {
    const int kind = data[0] % 6;
    const std::int64_t wait = data[1] + 256 * data[2];
    received_ns += wait * (data[0] >= 128 ? 1'000'000 : 1'000);
    data += 3;
    size -= 3;
    const std::size_t wanted = kind < 4 ? 1206 : (kind == 4 ? 512 : 255);
    const std::size_t length = std::min(size, wanted);
    std::vector<std::byte> payload(kind == 5 ? length : wanted);
    std::copy_n(lilo::fuzz::bytes_of(data, size).begin(), length, payload.begin());
    builder.feed({.received_ns = received_ns,
                  .source_ipv4 = 1,
                  .destination_port = static_cast<std::uint16_t>(kind == 4 ? 8308 : 2368),
                  .payload = payload});
    ++fed;
    data += length;
    size -= length;
  }
  const lilo::DriverCounts& c = builder.counts();
  require(c.data_packets + c.position_packets + c.malformed_packets + c.wrong_sensor_packets ==
          fed);
  return 0;
}
