// SPDX-License-Identifier: BSD-3-Clause
// Capture files, through libpcap, and captured frames of every link type, straight.
#include "drivers/link_layer.hpp"
#include "drivers/packet_source.hpp"
#include "tests/fuzz/fuzz_input.hpp"

#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace {

void read_file(const std::uint8_t* data, std::size_t size) {
  const int file = memfd_create("capture", 0);
  if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size)) return;
  try {
    const auto source = lilo::open_pcap("/proc/self/fd/" + std::to_string(file));
    lilo::PacketView packet;
    std::size_t sum = 0;
    while (source->read(packet, std::chrono::milliseconds(0)) == lilo::ReadResult::packet)
      for (const std::byte b : packet.payload) sum += std::to_integer<std::size_t>(b);
    lilo::fuzz::require(sum <= 255 * size);
    lilo::fuzz::require(source->error().find('\n') == std::string::npos);
  } catch (const lilo::DriverError&) {  // the one way to refuse
  }
  close(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const int link_type : {0, 1, 12, 101, 108, 113, 228, 276}) {
    const auto frame = lilo::parse_frame(link_type, lilo::fuzz::bytes_of(data, size));
    lilo::fuzz::require(frame.datagram.payload.size() <= size);
  }
  read_file(data, size);
  return 0;
}
