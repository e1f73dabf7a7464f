// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_message.hpp"
#include "drivers/packet_source.hpp"
#include "tests/daemon/operator.hpp"

#include <array>
#include <csignal>
#include <map>
#include <sstream>
#include <string>
#include <vector>

/// The sensor's packets, from a running daemon to clients that record them.
namespace lilo {
namespace {

constexpr const char* kOneClient = "  packets_clients: 1\n";
constexpr const char* kSubscribe = R"({"subscribe":{"ttl_s":5,"packets":true}})";

/// One UDP payload of a capture.
struct Payload {
  std::uint16_t port = 0;
  std::string bytes;
  bool operator==(const Payload&) const = default;
};

/// All of them, in order. That the stamps of each port go up is expected.
std::vector<Payload> payloads_of(const std::string& pcap) {
  const auto source = open_pcap(pcap);
  std::vector<Payload> out;
  std::map<std::uint16_t, std::int64_t> last_ns;
  for (PacketView packet; source->read(packet, milliseconds(0)) == ReadResult::packet;) {
    EXPECT_GE(packet.received_ns, last_ns[packet.destination_port]);
    last_ns[packet.destination_port] = packet.received_ns;
    const auto* bytes = reinterpret_cast<const char*>(packet.payload.data());
    out.push_back({packet.destination_port, std::string(bytes, packet.payload.size())});
  }
  EXPECT_EQ(source->error(), "");
  return out;
}

/// Where `lilo run` says the sensor was, without times: x y z qx qy qz qw of every pose.
std::vector<std::array<double, 7>> run(const std::string& pcap) {
  const std::string tum = unique_path("run.tum");
  const Finished ran = run_to_end({kLilo, "run", pcap, "--tum", tum});
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  std::vector<std::array<double, 7>> out;
  std::istringstream rows(text_of(tum));
  for (std::string row; std::getline(rows, row);) {
    std::istringstream numbers(row);
    double stamp_s = 0.0;
    numbers >> stamp_s;
    for (double& number : out.emplace_back()) numbers >> number;
  }
  return out;
}

/// A drive of some seconds, replayed to daemons.
class Packets : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = unique_path("drive");
    const Finished sim = run_to_end({kLilo, "sim", folder, "--quiet", "--duration-s", "3"});
    ASSERT_EQ(sim.exit_code, 0) << sim.error;
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder); }

  static std::string capture() { return folder + "/data.pcap"; }
  static void replay(const Lilod& lilod) {
    const Finished replayed =
        run_to_end({kLilo, "replay", capture(), "--data-port", std::to_string(lilod.data_port()),
                    "--position-port", std::to_string(lilod.position_port())});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.error;
    std::this_thread::sleep_for(milliseconds(500));  // what waits is worked off
  }
  static std::vector<std::string> record(const Lilod& lilod, const std::string& name) {
    return {kLilo,
            "record",
            name + ".jsonl",
            "--packets",
            name + ".pcap",
            "--port",
            std::to_string(lilod.server_port())};
  }

  static std::string folder;
};
std::string Packets::folder;

/// That the recorded packets are those sent, to lilod's ports. Data and position packets come by
/// two sockets, so each kind has an order of its own.
void expect_same_packets(const std::vector<Payload>& sent, const std::vector<Payload>& recorded,
                         const Lilod& lilod) {
  ASSERT_EQ(recorded.size(), sent.size());
  for (const auto& [port, own_port] : {std::pair{std::uint16_t{2368}, lilod.data_port()},
                                       std::pair{std::uint16_t{8308}, lilod.position_port()}}) {
    std::vector<std::string> expected, found;
    for (const Payload& payload : sent)
      if (payload.port == port) expected.push_back(payload.bytes);
    for (const Payload& payload : recorded)
      if (payload.port == own_port) found.push_back(payload.bytes);
    EXPECT_GT(expected.size(), 1U);
    EXPECT_TRUE(found == expected) << found.size() << " of " << expected.size() << " to " << port;
  }
}

TEST_F(Packets, AreRecordedByteForByte) {
  Lilod lilod(kOneClient);
  ASSERT_TRUE(lilod.wait_ready());
  const std::string name = unique_path("recorded");
  ChildProcess recorder(record(lilod, name));
  ASSERT_TRUE(health_where(lilod.sink(), "clients", 1).contains("health"));
  replay(lilod);
  recorder.signal(SIGINT);
  ASSERT_EQ(recorder.wait(seconds(10)), 0) << recorder.standard_error();
  EXPECT_NE(recorder.standard_output().find(" packets, none missed\n"), std::string::npos)
      << recorder.standard_output();
  expect_same_packets(payloads_of(capture()), payloads_of(name + ".pcap"), lilod);

  const auto expected = run(capture()), found = run(name + ".pcap");
  ASSERT_GT(expected.size(), 25U);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (std::size_t n = 0; n < 7; ++n) EXPECT_NEAR(found[k][n], expected[k][n], 1e-4) << k;
  }
}

TEST_F(Packets, AreRefusedWithAWordUnlessConfigured) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  const std::string name = unique_path("refused");
  const Finished refused = run_to_end(record(lilod, name));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.error,
            "lilo: 127.0.0.1:" + std::to_string(lilod.server_port()) +
                ": sends no packets: set subscribe.packets_clients in its configuration\n");
  EXPECT_FALSE(std::filesystem::exists(name + ".pcap"));
  EXPECT_FALSE(std::filesystem::exists(name + ".jsonl"));
  // Who asks all the same gets everything else.
  UdpSocket client;
  EXPECT_EQ(ask(client, lilod, kSubscribe, "hello")["hello"]["packets"], "off");
  Sensor().turn(lilod, 3.0);
  EXPECT_TRUE(next_of_kind(client, "pose"));
}

TEST_F(Packets, GoToNoMoreClientsThanConfigured) {
  Lilod lilod(kOneClient);
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket first;
  EXPECT_EQ(ask(first, lilod, kSubscribe, "hello")["hello"]["packets"], "granted");
  const Finished second = run_to_end(record(lilod, unique_path("second")));
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.error.find("other clients have them"), std::string::npos) << second.error;
  UdpSocket third;
  EXPECT_EQ(ask(third, lilod, R"({"subscribe":{}})", "hello")["hello"].count("packets"), 0U);
  ask(first, lilod, R"({"unsubscribe":{}})", "hello");
  EXPECT_EQ(ask(third, lilod, kSubscribe, "hello")["hello"]["packets"], "granted");
  Sensor().turn(lilod, 1.0);
  std::uint64_t packets = 0;
  while (const auto datagram = third.receive(milliseconds(300)))
    packets += is_packet(*datagram) ? 1 : 0;
  EXPECT_GT(packets, 70U);
  while (const auto datagram = first.receive(milliseconds(0))) EXPECT_FALSE(is_packet(*datagram));
}

// One that never reads: its packets are the kernel's to throw away. The other misses none, and the
// poses come as without.
TEST_F(Packets, AClientThatStallsHarmsNobody) {
  Lilod lilod("  packets_clients: 2\n");
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket stalled;
  stalled.send_to(lilod.server_port(), kSubscribe);
  const std::string name = unique_path("beside");
  ChildProcess recorder(record(lilod, name));
  ASSERT_TRUE(health_where(lilod.sink(), "clients", 2).contains("health"));
  replay(lilod);
  recorder.signal(SIGINT);
  ASSERT_EQ(recorder.wait(seconds(10)), 0) << recorder.standard_error();
  EXPECT_NE(recorder.standard_output().find(" packets, none missed\n"), std::string::npos)
      << recorder.standard_output();
  EXPECT_EQ(payloads_of(name + ".pcap").size(), payloads_of(capture()).size());
  UdpSocket client;
  const json health = ask(client, lilod, R"({"query":"health"})", "health");
  EXPECT_EQ(health["health"]["send_errors"], 0);
  EXPECT_EQ(health["health"]["scans"]["dropped"], 0);
  EXPECT_GT(health["health"]["poses_sent"], 25);
}

}  // namespace
}  // namespace lilo
