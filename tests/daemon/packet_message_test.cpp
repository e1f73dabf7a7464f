// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_message.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace lilo {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

PacketView a_packet(const std::string& payload) {
  return {.received_ns = 0x0102030405060708,
          .source_ipv4 = 0xC0A801C9,
          .source_port = 0x1122,
          .destination_port = 0x0940,
          .payload = bytes_of(payload)};
}

// Byte by byte as PROTOCOL.md has it: clients in other languages read it too.
TEST(PacketMessage, IsWhatTheDocumentSays) {
  PacketDatagram datagram;
  write_packet(0xA1A2A3A4A5A6A7A8, a_packet("{xyz}"), datagram);
  const std::string expected =
      std::string("LLPK\x01\x00\x00\x05", 8) + "\xA1\xA2\xA3\xA4\xA5\xA6\xA7\xA8" +
      "\x01\x02\x03\x04\x05\x06\x07\x08" + "\xC0\xA8\x01\xC9" + "\x11\x22" + "\x09\x40" + "{xyz}";
  EXPECT_EQ(datagram.view(), expected);
  EXPECT_TRUE(is_packet(datagram.view()));
  EXPECT_FALSE(is_packet(R"({"v":"2.0"})"));
}

TEST(PacketMessage, IsReadAsItWasWritten) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{512}, kMostPacketBytes}) {
    const std::string payload(size, '\xEE');
    const PacketView packet = a_packet(payload);
    PacketDatagram datagram;
    write_packet(17, packet, datagram);
    EXPECT_LT(datagram.size, 1400U);
    const auto read = read_packet(datagram.view());
    ASSERT_TRUE(read);
    EXPECT_EQ(read->seq, 17U);
    EXPECT_EQ(read->packet.received_ns, packet.received_ns);
    EXPECT_EQ(read->packet.source_ipv4, packet.source_ipv4);
    EXPECT_EQ(read->packet.source_port, packet.source_port);
    EXPECT_EQ(read->packet.destination_port, packet.destination_port);
    ASSERT_EQ(read->packet.payload.size(), size);
    EXPECT_TRUE(std::equal(payload.begin(), payload.end(), read->packet.payload.begin(),
                           [](char a, auto b) { return a == static_cast<char>(b); }));
  }
}

TEST(PacketMessage, RefusesWhatIsCutOrOfAnotherVersion) {
  const std::string payload(100, 'x');
  PacketDatagram datagram;
  write_packet(17, a_packet(payload), datagram);
  const std::string good(datagram.view());
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(read_packet(good.substr(0, size))) << size;
  EXPECT_FALSE(read_packet(good + 'x'));
  std::string other = good;
  other[4] = 2;
  EXPECT_FALSE(read_packet(other));
  std::string flagged = good;
  flagged[5] = 1;
  EXPECT_TRUE(read_packet(flagged)) << "flags that we do not know are ignored";
}

}  // namespace
}  // namespace lilo
