// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_message.hpp"
#include "tests/daemon/conversation.hpp"
#include "tests/daemon/tun_network.hpp"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <system_error>
#include <unistd.h>

/// What others on the network can do to the daemon, and by it to third parties, in a network in
/// which the test is everybody else.
namespace lilo {
namespace {

using Endpoint = TunNetwork::Endpoint;

constexpr const char* kSubscribe = R"({"subscribe":{}})";

std::string padded(std::string request) {
  request.resize(256, ' ');
  return request;
}

std::string with_token(const std::string& token) {
  return padded(R"({"subscribe":{},"token":")" + token + "\"}");
}

std::string random_bytes(std::mt19937& rng, std::size_t size) {
  std::string out(size, '\0');
  for (char& c : out) c = static_cast<char>(rng());
  return out;
}

/// Garbage, oversized, truncated and forged, by turns.
std::string hostile_request(std::mt19937& rng) {
  const std::string good = R"({"reset":{"pose":{"position":{"x":1,"y":2,"z":3}}},"token":"0"})";
  switch (rng() % 5) {
    case 0:
      return random_bytes(rng, rng() % 600);
    case 1:
      return R"({"subscribe":{},"x":")" + std::string(1300, 'x') + "\"}";
    case 2:
      return good.substr(0, rng() % good.size());
    case 3:
      return std::string(512, "[{\""[rng() % 3]);
    default:
      return with_token("0123456789abcdef");
  }
}

class Hostile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    try {
      network = std::make_unique<TunNetwork>();
    } catch (const std::system_error& error) {
      refusal = error.what();
    }
  }
  static void TearDownTestSuite() { network.reset(); }
  void SetUp() override {
    if (!network) GTEST_SKIP() << "no network of our own: " << refusal;
  }

  /// All that went out until `quiet` has passed without any.
  static std::vector<TunNetwork::Datagram> sent_out(milliseconds quiet = milliseconds(300)) {
    std::vector<TunNetwork::Datagram> out;
    while (auto datagram = network->receive(quiet)) out.push_back(std::move(*datagram));
    return out;
  }

  static std::unique_ptr<TunNetwork> network;
  static std::string refusal;
};
std::unique_ptr<TunNetwork> Hostile::network;
std::string Hostile::refusal;

constexpr const char* kOpen = "  bind_address: 0.0.0.0\n  allow: [10.77.0.2, 10.77.0.3]\n";

/// As the daemon says next of itself.
json health_of(Lilod& lilod) {
  while (lilod.sink().receive(milliseconds(0))) {
  }
  return next_of_kind(lilod.sink(), "health").value_or(json())["health"];
}

// Else a forged sender could have others flooded at our expense.
TEST_F(Hostile, NobodyIsSentMoreThanCameInHisName) {
  Lilod lilod(kOpen);
  ASSERT_TRUE(lilod.wait_ready());
  std::mt19937 rng(1);
  std::vector<std::string> requests{kSubscribe, R"({"query":"pose"})", "", "{",
                                    "[]",       padded(kSubscribe)};
  while (requests.size() < 30) requests.push_back(hostile_request(rng));
  std::map<Endpoint, std::size_t> bytes_in, bytes_out;
  std::uint16_t port = 1000;
  for (const std::string& request : requests) {
    const Endpoint allowed = TunNetwork::host(0, 2, port), stranger = TunNetwork::host(9, 9, port);
    network->send(allowed, lilod.server_port(), request);
    network->send(stranger, lilod.server_port(), request);
    bytes_in[allowed] = request.size();
    ++port;
  }
  int answers_to_the_padded_one = 0;
  for (const auto& [to, payload] : sent_out()) {
    bytes_out[to] += payload.size();
    const json message = json::parse(payload);
    EXPECT_EQ(violations(protocol_schema(), message), std::vector<std::string>{}) << payload;
    if (to == TunNetwork::host(0, 2, 1005)) ++answers_to_the_padded_one;
  }
  for (const auto& [to, bytes] : bytes_out) EXPECT_LE(bytes, bytes_in[to]) << "port " << to.port;
  EXPECT_EQ(answers_to_the_padded_one, 1) << "it can be answered, and was";
  EXPECT_EQ(bytes_out.count(TunNetwork::host(0, 2, 1000)), 0U);
}

TEST_F(Hostile, ATokenServesItsOwnerAlone) {
  Lilod lilod(kOpen);
  ASSERT_TRUE(lilod.wait_ready());
  const Endpoint owner = TunNetwork::host(0, 2, 5000);
  network->send(owner, lilod.server_port(), padded(kSubscribe));
  const auto first = network->receive(seconds(5));
  ASSERT_TRUE(first);
  ASSERT_EQ(first->to, owner);
  const std::string token = json::parse(first->payload)["hello"]["token"];
  for (const Endpoint& thief : {TunNetwork::host(0, 2, 5001), TunNetwork::host(0, 3, 5000)}) {
    network->send(thief, lilod.server_port(), with_token(token));
    const auto answer = network->receive(seconds(5));
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->to, thief);
    EXPECT_NE(json::parse(answer->payload)["hello"]["token"], token);
  }
  EXPECT_EQ(health_of(lilod)["clients"], 0);
  network->send(owner, lilod.server_port(), with_token(token));
  const auto granted = network->receive(seconds(5));
  ASSERT_TRUE(granted);
  EXPECT_FALSE(json::parse(granted->payload)["hello"].contains("token"));
  EXPECT_EQ(health_of(lilod)["clients"], 1);
  Sensor().turn(lilod, 3.0);
  bool poses = false;
  for (const auto& datagram : sent_out()) {
    EXPECT_EQ(datagram.to, owner);
    poses = poses || json::parse(datagram.payload).contains("pose");
  }
  EXPECT_TRUE(poses);
}

// Ten times as many bytes as poses: nobody must be able to have them sent to a third party.
TEST_F(Hostile, PacketsGoToTheOwnerOfATokenAlone) {
  Lilod lilod(std::string(kOpen) + "  packets_clients: 1\n");
  ASSERT_TRUE(lilod.wait_ready());
  const auto request = [](const std::string& token) {
    return padded(R"({"subscribe":{"packets":true},"token":")" + token + "\"}");
  };
  const Endpoint owner = TunNetwork::host(0, 2, 5000), other = TunNetwork::host(0, 3, 5000),
                 stranger = TunNetwork::host(9, 9, 5000);
  for (const Endpoint& from : {owner, other, stranger})
    network->send(from, lilod.server_port(), request("0123456789abcdef"));
  Sensor().turn(lilod, 1.0);
  std::string token;
  for (const auto& datagram : sent_out()) {
    ASSERT_FALSE(is_packet(datagram.payload));
    EXPECT_LE(datagram.payload.size(), 256U);
    if (datagram.to == owner) token = json::parse(datagram.payload)["hello"]["token"];
  }
  network->send(owner, lilod.server_port(), request(token));
  network->send(other, lilod.server_port(), request(token));
  EXPECT_EQ(health_of(lilod)["clients"], 1);
  Sensor().turn(lilod, 1.0);
  std::uint64_t packets = 0;
  for (const auto& datagram : sent_out()) {
    if (!is_packet(datagram.payload)) continue;
    EXPECT_EQ(datagram.to, owner);
    ++packets;
  }
  EXPECT_GT(packets, 70U);
}

long resident_kb(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;) {
    long kb = 0;
    if (word == "VmRSS:" && status >> kb) return kb;
  }
  return -1;
}

// From hosts that may ask and hosts that may not, each from a port of its own.
TEST_F(Hostile, TenThousandForgedSubscribersTakeNoMemory) {
  // AddressSanitizer would keep what was freed.
  Lilod lilod(kOpen, {{"ASAN_OPTIONS", "quarantine_size_mb=0"}});
  ASSERT_TRUE(lilod.wait_ready());
  std::mt19937 rng(2);
  std::size_t bytes_in = 0, bytes_out = 0, answers = 0;
  const auto forge = [&](unsigned count) {
    for (unsigned k = 0; k < count; ++k) {
      const unsigned third = k % 2 == 0 ? 0 : 1 + k % 250;
      const Endpoint from =
          TunNetwork::host(third, 2 + k / 2 % 2, static_cast<std::uint16_t>(1024 + k));
      for (const std::string& request :
           {padded(kSubscribe), std::string(kSubscribe), hostile_request(rng)}) {
        network->send(from, lilod.server_port(), request);
        bytes_in += request.size();
      }
      if (k % 20 == 0) std::this_thread::sleep_for(milliseconds(2));  // they are to be read
    }
  };
  const auto began = std::chrono::steady_clock::now();
  forge(500);
  ASSERT_EQ(health_of(lilod)["clients"], 0);
  const long before_kb = resident_kb(lilod.process().pid());
  forge(10'000);
  EXPECT_EQ(health_of(lilod)["clients"], 0);
  const long after_kb = resident_kb(lilod.process().pid());
  for (const auto& datagram : sent_out()) {
    bytes_out += datagram.payload.size();
    ++answers;
  }
  // On a busy computer the last requests are answered long after they were sent.
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  EXPECT_GT(before_kb, 0);
  EXPECT_LE(after_kb, before_kb + 512);
  EXPECT_GT(answers, 0U);
  EXPECT_LE(static_cast<double>(answers), 50.0 * (took.count() + 2.0));
  EXPECT_LT(bytes_out, bytes_in);
  std::cout << "VmRSS " << before_kb << " kB, then " << after_kb << " kB; bytes in " << bytes_in
            << ", out " << bytes_out << "; " << answers << " answers in " << took.count() << " s\n";
}

/// Requests of every kind from forged senders and from this computer until the object goes.
class Attack {
 public:
  Attack(const TunNetwork& network, const Lilod& lilod)
      : thread_([this, &network, port = lilod.server_port()] {
          std::mt19937 rng(3);
          UdpSocket local;
          for (; !stop_; ++rounds) {
            const Endpoint from = TunNetwork::host(0, 2, static_cast<std::uint16_t>(rng()));
            network.send(from, port, hostile_request(rng));
            network.send(from, port, padded(kSubscribe));
            local.send_to(port, hostile_request(rng));
            std::this_thread::sleep_for(std::chrono::microseconds(300));
          }
        }) {}
  ~Attack() {
    stop_ = true;
    thread_.join();
  }
  Attack(const Attack&) = delete;
  Attack& operator=(const Attack&) = delete;

  std::atomic<int> rounds{0};

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// All poses of a capture, without what is another in every run.
std::vector<json> poses_of(const std::string& pcap, Lilod& lilod) {
  const std::string lilo = LILO_BIN_DIR "/lilo";
  ChildProcess replay({lilo, "replay", pcap, "--data-port", std::to_string(lilod.data_port()),
                       "--position-port", std::to_string(lilod.position_port())});
  EXPECT_EQ(replay.wait(seconds(60)), 0) << replay.standard_error();
  std::this_thread::sleep_for(milliseconds(1000));  // what waits is worked off
  EXPECT_EQ(lilod.stop(), 0);
  std::vector<json> out;
  while (const auto datagram = lilod.sink().receive(milliseconds(100))) {
    json message = json::parse(*datagram);
    if (!message.contains("pose")) continue;
    for (const char* key : {"timestamp", "session"}) message.erase(key);
    for (const char* key : {"latency_ms", "stamp"}) message["pose"].erase(key);
    out.push_back(std::move(message));
  }
  return out;
}

TEST_F(Hostile, PosesAreThoseOfAQuietNetwork) {
  const std::string folder = testing::TempDir() + "lilo_hostile_" + std::to_string(getpid());
  const std::string lilo = LILO_BIN_DIR "/lilo";
  const Finished sim = run_to_end({lilo, "sim", folder, "--quiet", "--duration-s", "2.5"});
  ASSERT_EQ(sim.exit_code, 0) << sim.error;
  const std::string slots = std::string(kOpen) + "realtime:\n  ring_slots: 64\n";
  Lilod quiet(slots), attacked(slots);
  ASSERT_TRUE(quiet.wait_ready());
  const std::vector<json> expected = poses_of(folder + "/data.pcap", quiet);
  ASSERT_TRUE(attacked.wait_ready());
  std::vector<json> found;
  {
    const Attack attack(*network, attacked);
    found = poses_of(folder + "/data.pcap", attacked);
    EXPECT_GT(attack.rounds, 1000);
  }
  std::filesystem::remove_all(folder);
  ASSERT_GT(expected.size(), 20U);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k], expected[k]) << k;
  EXPECT_GT(expected.back()["pose"]["position"]["x"], 1.0) << "it moved";
}

}  // namespace
}  // namespace lilo
