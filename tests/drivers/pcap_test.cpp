// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/link_layer.hpp"
#include "drivers/packet_source.hpp"
#include "drivers/scan_source.hpp"
#include "tests/drivers/capture_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace lilo {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): the writers of frames

const Buffer kPayload = [] {
  Buffer bytes;
  for (int i = 0; i < 100; ++i) bytes.push_back(static_cast<std::byte>(i));
  return bytes;
}();
constexpr std::int64_t kTime = 1'715'678'101'123'457'000;

struct Read {
  std::vector<Buffer> payloads;
  std::vector<std::int64_t> times_ns;
  SourceCounts counts;
  std::string error;
};

Read read_all(const std::string& path) {
  auto source = open_pcap(path);
  Read out;
  PacketView packet;
  while (source->read(packet, std::chrono::milliseconds(0)) == ReadResult::packet) {
    out.payloads.emplace_back(packet.payload.begin(), packet.payload.end());
    out.times_ns.push_back(packet.received_ns);
  }
  EXPECT_EQ(source->progress(), 1.0);
  out.counts = source->counts();
  out.error = source->error();
  return out;
}

// The message of the DriverError, which must be one line.
std::string refusal(const std::string& path) {
  try {
    open_scans(path, {});
  } catch (const DriverError& e) {
    std::string message = e.what();
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  }
  return "opened";
}

struct LinkCase {
  std::string name;
  int link_type;
  Buffer frame;
};
void PrintTo(const LinkCase& c, std::ostream* out) { *out << c.name; }

class LinkLayer : public testing::TestWithParam<LinkCase> {};

TEST_P(LinkLayer, PayloadIsFound) {
  const LinkCase& c = GetParam();
  // A file of its own: the cases run beside each other.
  const std::string path = write_file("link_" + c.name + ".pcap",
                                      pcap_bytes({{c.frame, kTime}}, {.link_type = c.link_type}));
  const Read out = read_all(path);
  ASSERT_EQ(out.payloads.size(), 1U);
  EXPECT_EQ(out.payloads[0], kPayload);
  EXPECT_EQ(out.times_ns[0], kTime);
}

TEST_P(LinkLayer, EveryShorterCaptureIsCountedAsTruncated) {
  const LinkCase& c = GetParam();
  for (std::size_t length = 0; length < c.frame.size(); ++length) {
    const Frame frame = parse_frame(c.link_type, std::span(c.frame).first(length));
    EXPECT_EQ(frame.kind, FrameKind::truncated) << length;
  }
}

const Buffer kIp = ipv4(udp_datagram(kPayload));
INSTANTIATE_TEST_SUITE_P(
    Types, LinkLayer,
    testing::Values(LinkCase{"ethernet", 1, ethernet(kIp)},
                    LinkCase{"vlan", 1, ethernet(kIp, {0x8100})},
                    LinkCase{"two_vlans", 1, ethernet(kIp, {0x88A8, 0x8100})},
                    LinkCase{"ip_options", 1, ethernet(ipv4(udp_datagram(kPayload), 40))},
                    LinkCase{"cooked", 113, cooked(kIp)}, LinkCase{"cooked2", 276, cooked2(kIp)},
                    LinkCase{"raw", 101, kIp}),
    [](const auto& test_case) { return test_case.param.name; });

// Numbers and names are those of the registry at tcpdump.org/linktypes.html.
TEST(LinkLayerName, IsToldAsLibpcapNamesIt) {
  const std::pair<int, const char*> names[] = {
      {1, "EN10MB"}, {113, "LINUX_SLL"}, {276, "LINUX_SLL2"}, {101, "RAW"}};
  for (const auto& [type, name] : names) {
    const auto path = write_file("name.pcap", pcap_bytes({{kIp, kTime}}, {.link_type = type}));
    EXPECT_EQ(open_pcap(path)->link_type(), name);
    EXPECT_EQ(open_scans(path, {})->link_type(), name);
  }
}

TEST(LinkLayerForeign, OtherTrafficIsCountedAndSkipped) {
  Buffer ipv6 = kIp;
  ipv6[0] = std::byte{0x60};
  Buffer short_udp = udp_datagram(kPayload);
  short_udp[4] = short_udp[5] = std::byte{0};
  const std::vector<Record> records = {
      {ethernet(Buffer(46), {}, 0x0806), kTime},                   // ARP
      {ethernet(ipv6, {}, 0x86DD), kTime},                         // IPv6
      {ethernet(ipv4(Buffer(20), 0, 0, 6)), kTime},                // TCP
      {ethernet(ipv6), kTime},                                     // says IPv4 and is not
      {ethernet(ipv4(short_udp)), kTime},                          // UDP shorter than its header
      {ethernet(ipv4(udp_datagram(kPayload), 0, 0x2000)), kTime},  // first fragment
      {ethernet(ipv4(Buffer(64), 0, 0x0010)), kTime},              // a later one
      {ethernet(kIp), kTime, 60},
      {ethernet(kIp), kTime},
  };
  const Read out = read_all(write_file("foreign.pcap", pcap_bytes(records)));
  EXPECT_EQ(out.payloads.size(), 1U);
  EXPECT_EQ(out.counts.packets, 1U);
  EXPECT_EQ(out.counts.foreign, 5U);
  EXPECT_EQ(out.counts.fragments, 2U);
  EXPECT_EQ(out.counts.truncated, 1U);
  EXPECT_EQ(out.error, "");
}

TEST(PcapFormat, BothResolutionsAndByteOrders) {
  for (const bool nanoseconds : {false, true})
    for (const bool big_endian : {false, true}) {
      const CaptureFormat format{.nanoseconds = nanoseconds, .big_endian = big_endian};
      const Read out =
          read_all(write_file("format.pcap", pcap_bytes({{ethernet(kIp), kTime + 89}}, format)));
      ASSERT_EQ(out.payloads.size(), 1U);
      EXPECT_EQ(out.payloads[0], kPayload);
      EXPECT_EQ(out.times_ns[0], nanoseconds ? kTime + 89 : kTime);
    }
}

TEST(PcapFormat, Pcapng) {
  const Read out = read_all(
      write_file("format.pcapng", pcapng_bytes({{ethernet(kIp), kTime}, {ethernet(kIp), kTime}})));
  ASSERT_EQ(out.payloads.size(), 2U);
  EXPECT_EQ(out.payloads[1], kPayload);
  EXPECT_EQ(out.times_ns[0], kTime);
}

TEST(PcapErrors, EachIsOneClearLine) {
  EXPECT_NE(refusal("/nowhere/at/all.pcap").find("/nowhere/at/all.pcap: cannot be opened"),
            std::string::npos);
  EXPECT_NE(refusal(write_file("empty.pcap", "")).find("found an empty file"), std::string::npos);
  EXPECT_NE(refusal(write_file("text.pcap", "this is no capture, is it?"))
                .find("expected a pcap or pcapng capture"),
            std::string::npos);
  EXPECT_NE(refusal(write_file("header.pcap", pcap_bytes({}).substr(0, 11)))
                .find("expected a pcap or pcapng capture"),
            std::string::npos);
  EXPECT_NE(refusal(write_file("wifi.pcap", pcap_bytes({}, {.link_type = 105})))
                .find("expected frames of Ethernet"),
            std::string::npos);
}

TEST(PcapErrors, ATruncatedFileGivesWhatItHoldsAndSaysSo) {
  const std::string whole = pcap_bytes(records_of(vlp16_packets(170, {})));
  const std::string path = write_file("truncated.pcap", whole.substr(0, whole.size() - 700));
  auto source = open_scans(path, {});
  Scan scan;
  int scans = 0;
  while (source->next(scan)) ++scans;
  EXPECT_EQ(scans, 2);
  EXPECT_EQ(source->driver_counts().data_packets, 169U);
  EXPECT_NE(source->error().find(path), std::string::npos);
  EXPECT_EQ(source->error().find('\n'), std::string::npos);
  EXPECT_EQ(read_all(write_file("whole.pcap", whole)).error, "");
}

TEST(PcapErrors, InterfacesOfTwoLinkTypesAreCalledThat) {
  std::string bytes = pcapng_bytes({{ethernet(kIp), kTime}});
  for (const unsigned word : {1U, 20U, 113U, 0U, 20U}) {  // another interface: Linux cooked
    for (unsigned k = 0; k < 4; ++k) bytes += static_cast<char>(word >> (8 * k) & 0xFFU);
  }
  const std::string path = write_file("two_links.pcapng", bytes);
  const Read out = read_all(path);
  EXPECT_EQ(out.payloads.size(), 1U);
  EXPECT_EQ(out.error.rfind(path + ": expected interfaces that are all alike", 0), 0U) << out.error;
  EXPECT_EQ(out.error.find("damaged"), std::string::npos);
}

TEST(PcapScans, CanBeReadFromStandardInput) {
  const std::string path = write_file("stdin.pcap", pcap_bytes(records_of(vlp16_packets(170, {}))));
  ASSERT_NE(std::freopen(path.c_str(), "rb", stdin), nullptr);
  auto source = open_scans("-", {});
  Scan scan;
  int scans = 0;
  while (source->next(scan)) ++scans;
  EXPECT_EQ(scans, 2);
}

TEST(PcapScans, UseTheTableTheCaptureCarriesFromTheFirstScan) {
  const HdlOptions options{.drive = {.rpm = 1200, .start_azimuth_deg = 300},
                           .calibration = sample_calibration(true)};
  const auto packets = hdl64e_packets(4300, options);
  const std::string path = write_file("hdl.pcap", pcap_bytes(records_of(packets)));
  auto source = open_scans(path, {});
  Scan scan;
  ASSERT_TRUE(source->next(scan));
  EXPECT_EQ(scan.index, 0U);
  EXPECT_EQ(source->sensor_status().calibration, CalibrationOrigin::packets);
  EXPECT_LT(scan.start_ns - packets[0].received_ns, 15'000'000);
  for (const Return& p : scan.returns) ASSERT_LT(Room::distance_to_surface_m(p), 0.002);
}

}  // namespace
}  // namespace lilo
