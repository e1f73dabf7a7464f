// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/packet_recording.hpp"

#include "daemon/packet_message.hpp"
#include "drivers/packet_source.hpp"
#include "tests/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lilo {
namespace {

PacketDatagram packet_with(std::uint64_t seq) {
  const std::string payload = "packet " + std::to_string(seq);
  PacketDatagram out;
  write_packet(seq,
               {.received_ns = 1'700'000'000'123'456'789 + static_cast<std::int64_t>(seq),
                .source_ipv4 = 0xC0A801C9,
                .source_port = 443,
                .destination_port = 2368,
                .payload = std::as_bytes(std::span(payload))},
               out);
  return out;
}

TEST(PacketRecording, CountsWhatIsMissing) {
  const TemporaryFolder folder;
  PacketRecording recording(folder.path() + "/a.pcap");
  for (const std::uint64_t seq : {70U, 71U, 75U, 76U, 73U, 77U})
    recording.take(packet_with(seq).view());
  EXPECT_EQ(recording.missed(), 2U) << "73 was overtaken on the way";
  recording.take(packet_with(0).view());  // lilod has started again
  recording.take(packet_with(1).view());
  recording.take("LLPK, but no packet");
  EXPECT_EQ(recording.packets(), 8U);
  EXPECT_EQ(recording.missed(), 2U);
  EXPECT_EQ(to_text(recording).rfind("8 packets, 2 missed: ", 0), 0U) << to_text(recording);
}

TEST(PacketRecording, IsACaptureWithAddressesAndStamps) {
  const TemporaryFolder folder;
  PacketRecording recording(folder.path() + "/a.pcap");
  for (std::uint64_t seq = 0; seq < 3; ++seq) recording.take(packet_with(seq).view());
  recording.finish();
  const auto source = open_pcap(folder.path() + "/a.pcap");
  PacketView packet;
  for (std::int64_t k = 0; k < 3; ++k) {
    ASSERT_EQ(source->read(packet, {}), ReadResult::packet);
    EXPECT_EQ(packet.received_ns, 1'700'000'000'123'456'789 + k);
    EXPECT_EQ(packet.source_ipv4, 0xC0A801C9);
    EXPECT_EQ(packet.source_port, 443);
    EXPECT_EQ(packet.destination_port, 2368);
    EXPECT_EQ(packet.payload.size(), 8U);
  }
  EXPECT_EQ(source->read(packet, {}), ReadResult::end);
}

}  // namespace
}  // namespace lilo
