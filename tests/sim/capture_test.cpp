// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sim/rig_fixture.hpp"
#include "tools/sim/addresses.hpp"
#include "tools/sim/position_packet.hpp"

#include <gtest/gtest.h>
#include <pcap/pcap.h>

#include <filesystem>
#include <string>

namespace lilo::sim {
namespace {

TEST(PositionPacket, HoldsStampPpsAndACheckedSentence) {
  // 2026-11-21 09:59:59.900 UTC: the sentence of that second has come.
  constexpr std::int64_t kUtc = 1'795'255'199'900'000'000;
  const Packet packet = encode_position(0, kUtc, 3'599'900'000U);
  ASSERT_EQ(packet.payload.size(), 512U);
  EXPECT_EQ(packet.port, 8308);
  EXPECT_EQ(u32_at(packet, 0xC6), 3'599'900'000U);
  EXPECT_EQ(packet.payload[0xCA], 2);  // PPS locked
  const std::string sentence(packet.payload.begin() + 0xCE, packet.payload.begin() + 0xCE + 128);
  EXPECT_EQ(sentence.substr(0, 16), "$GPRMC,095959,A,");
  EXPECT_NE(sentence.find(",211126,"), std::string::npos);
  const std::size_t star = sentence.find('*');
  unsigned sum = 0;
  for (std::size_t k = 1; k < star; ++k) sum ^= static_cast<unsigned char>(sentence[k]);
  EXPECT_EQ(std::stoul(sentence.substr(star + 1, 2), nullptr, 16), sum);
  EXPECT_EQ(sentence.substr(star + 3, 3), std::string("\r\n\0", 3));
}

TEST(PositionPacket, SentenceComesAfterItsSecond) {
  constexpr std::int64_t kUtc = 1'795'255'200'050'000'000;  // 10:00:00.05
  const Packet packet = encode_position(0, kUtc, 50'000U);
  const std::string sentence(packet.payload.begin() + 0xCE, packet.payload.begin() + 0xCE + 16);
  EXPECT_EQ(sentence, "$GPRMC,095959,A,");
}

class Pcap : public testing::TestWithParam<bool> {};

TEST_P(Pcap, LibpcapReadsTheFramesBack) {
  const bool nanoseconds = GetParam();
  const auto path = std::filesystem::path(testing::TempDir()) / "lilo_sim_frames.pcap";
  Packet packet{0, 2368, std::vector<std::uint8_t>(1206)};
  for (std::size_t k = 0; k < packet.payload.size(); ++k)
    packet.payload[k] = static_cast<std::uint8_t>(k);
  {
    PcapWriter writer(path.string(), nanoseconds);
    const auto payload = std::as_bytes(std::span(packet.payload));
    writer.write(addresses_of(packet), payload, 1'700'000'000'123'456'789);
    packet.port = 8308;
    writer.write(addresses_of(packet), payload, 1'700'000'001'000'000'001);
    writer.close();
  }
  char reason[PCAP_ERRBUF_SIZE];
  pcap_t* file =
      pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, reason);
  ASSERT_NE(file, nullptr) << reason;
  EXPECT_EQ(pcap_datalink(file), DLT_EN10MB);
  bpf_program filter{};
  // libpcap's own parser of Ethernet, IP and UDP judges the headers.
  ASSERT_EQ(pcap_compile(file, &filter,
                         "udp and dst port 2368 and src host 192.168.1.201 and ip broadcast", 1,
                         PCAP_NETMASK_UNKNOWN & 0),
            0)
      << pcap_geterr(file);
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  ASSERT_EQ(pcap_next_ex(file, &header, &bytes), 1);
  EXPECT_NE(pcap_offline_filter(&filter, header, bytes), 0);
  EXPECT_EQ(header->caplen, 1248U);
  EXPECT_EQ(header->len, 1248U);
  EXPECT_EQ(header->ts.tv_sec, 1'700'000'000);
  EXPECT_EQ(header->ts.tv_usec, nanoseconds ? 123'456'789 : 123'456'000);
  unsigned sum = 0;  // over a right IP header, its checksum included, the sum is all ones
  for (int k = 14; k < 34; k += 2) sum += static_cast<unsigned>(bytes[k] << 8 | bytes[k + 1]);
  EXPECT_EQ((sum & 0xFFFFU) + (sum >> 16U), 0xFFFFU);
  EXPECT_TRUE(std::equal(packet.payload.begin(), packet.payload.end(), bytes + 42));
  ASSERT_EQ(pcap_next_ex(file, &header, &bytes), 1);
  EXPECT_EQ(pcap_offline_filter(&filter, header, bytes), 0);  // the other port
  EXPECT_EQ(pcap_next_ex(file, &header, &bytes), PCAP_ERROR_BREAK);
  pcap_freecode(&filter);
  pcap_close(file);
  std::filesystem::remove(path);
}

INSTANTIATE_TEST_SUITE_P(MicroAndNano, Pcap, testing::Bool());

TEST(PcapWriter, NamesTheFileItCannotMake) {
  try {
    const PcapWriter writer("/no/such/folder/x.pcap", false);
    FAIL() << "expected an exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/folder/x.pcap"), std::string::npos);
  }
}

}  // namespace
}  // namespace lilo::sim
