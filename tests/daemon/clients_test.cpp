// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/conversation.hpp"
#include "tools/clients/lilo_client.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>

/// The clients we give away, against the daemon itself.
namespace lilo {
namespace {

const std::string kPython = "/usr/bin/python3";

/// One more sink, by a reload.
void add_sink(Lilod& lilod, const std::string& endpoint) {
  lilod.change_config("sinks: [", "sinks: [\"" + endpoint + "\", ");
  EXPECT_TRUE(lilod.systemd().wait_for("READY=1", seconds(10)));
}

/// Runs an example that prints ten lines "seq status x y z".
void expect_ten_poses(std::vector<std::string> command, const std::string& host,
                      const Lilod& lilod) {
  command.push_back(host);
  command.push_back(std::to_string(lilod.server_port()));
  const Finished run = run_to_end(command);
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 10) << run.output << run.error;
}

TEST(Clients, ExamplesPrintPoses) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  const Turning turning(lilod);
  expect_ten_poses({LILO_TESTS_DIR "/print_poses"}, "127.0.0.1", lilod);
  if (std::filesystem::exists(kPython))
    expect_ten_poses({kPython, LILO_CLIENTS_DIR "/print_poses.py"}, "127.0.0.1", lilod);
}

// From another address they have to be allowed, and echo the token.
TEST(Clients, OtherAddressesEchoTheToken) {
  const auto address = outer_address();
  if (!address) GTEST_SKIP() << "this computer has no address but loopback";
  Lilod lilod("  bind_address: 0.0.0.0\n  allow: [" + *address + "]\n");
  ASSERT_TRUE(lilod.wait_ready());
  const Turning turning(lilod);
  expect_ten_poses({LILO_TESTS_DIR "/print_poses"}, *address, lilod);
  if (std::filesystem::exists(kPython))
    expect_ten_poses({kPython, LILO_CLIENTS_DIR "/print_poses.py"}, *address, lilod);
}

TEST(Clients, StrangersGetNoAnswer) {
  const auto address = outer_address();
  if (!address) GTEST_SKIP() << "this computer has no address but loopback";
  Lilod lilod("  bind_address: 0.0.0.0\n");
  ASSERT_TRUE(lilod.wait_ready());
  const Turning turning(lilod);
  Client client(*address, lilod.server_port());
  ClientPose pose;
  EXPECT_FALSE(client.next(pose, milliseconds(1500)));
}

// The client outlives the daemon: its poses go on, in another session.
TEST(Clients, SeeANewSessionAfterARestart) {
  auto lilod = std::make_unique<Lilod>();
  ASSERT_TRUE(lilod->wait_ready());
  Client client("127.0.0.1", lilod->server_port());
  ClientPose pose;
  {
    const Turning turning(*lilod);
    ASSERT_TRUE(client.next(pose));
  }
  const std::string before = pose.session;
  lilod->restart();
  ASSERT_TRUE(lilod->wait_ready());
  const Turning turning(*lilod);
  const auto deadline = std::chrono::steady_clock::now() + seconds(5);
  while (pose.session == before && std::chrono::steady_clock::now() < deadline) client.next(pose);
  EXPECT_NE(pose.session, before);
}

TEST(Clients, CppClientReadsEveryField) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  Client client("127.0.0.1", lilod.server_port());
  ClientPose pose;
  std::optional<json> raw;
  {
    const Turning turning(lilod);
    ASSERT_TRUE(client.next(pose));
    do raw = next_of_kind(lilod.sink(), "pose");
    while (raw && (*raw)["seq"] != pose.seq);
  }
  ASSERT_TRUE(raw);
  const json& m = (*raw)["pose"];
  EXPECT_EQ(pose.session, (*raw)["session"]);
  EXPECT_DOUBLE_EQ(pose.timestamp, (*raw)["timestamp"].get<double>());
  EXPECT_EQ(pose.status, m["status"]);
  EXPECT_EQ(pose.child_frame_id, m["child_frame_id"]);
  EXPECT_DOUBLE_EQ(pose.position[2], m["position"]["z"].get<double>());
  EXPECT_DOUBLE_EQ(pose.orientation[3], m["orientation"]["w"].get<double>());
  EXPECT_EQ(pose.has_twist, m.contains("twist"));
  EXPECT_EQ(pose.has_covariance, m.contains("covariance"));
}

/// The series PlotJuggler's UDP server makes of a datagram, by its nlohmann_parsers.cpp: numbers
/// and booleans under their path; strings and null are passed over.
void add_series(const json& value, const std::string& path, std::map<std::string, double>& out) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items())
      add_series(inner, std::string(path).append("/").append(key), out);
  } else if (value.is_array()) {
    for (std::size_t k = 0; k < value.size(); ++k)
      add_series(value[k], path + '[' + std::to_string(k) + ']', out);
  } else if (value.is_boolean()) {
    out[path] = value.get<bool>() ? 1.0 : 0.0;
  } else if (value.is_number()) {
    out[path] = value.get<double>();
  }
}

// A fixed sink and nothing else: every datagram has the stamp it was told to look for, as a number
// at the top, and no series mixes two kinds of message.
TEST(PlotJuggler, ReadsAllThatASinkIsSent) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  Sensor().turn(lilod, 12.0);
  std::map<std::string, std::map<std::string, double>> of_kind;
  while (const auto datagram = lilod.sink().receive(milliseconds(1200))) {
    const json message = json::parse(*datagram);
    ASSERT_TRUE(message["timestamp"].is_number()) << *datagram;
    const std::string kind = message.contains("pose") ? "pose" : "health";
    add_series(message, "", of_kind[kind]);
    if (of_kind.size() == 2 && of_kind["pose"].contains("/pose/position/x") &&
        message.contains("health") && message["health"]["poses_sent"] > 5)
      break;
  }
  for (const char* series : {"/timestamp", "/seq", "/pose/position/x", "/pose/orientation/w",
                             "/pose/latency_ms", "/pose/lost_packets"})
    EXPECT_EQ(of_kind["pose"].count(series), 1U) << series;
  EXPECT_EQ(of_kind["health"].count("/health/latency_ms/p99"), 1U);
  for (const auto& [series, value] : of_kind["health"]) {
    EXPECT_EQ(of_kind["pose"].count(series), series == "/timestamp" ? 1U : 0U) << series;
  }
}

// A table for people, datagrams for programs, a file for evo.
TEST(Listen, PrintsJsonLinesAndATumFile) {
  const std::string port = std::to_string(free_udp_port());
  const TemporaryFile tum("listen.tum", "");
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  const std::string lilo = LILO_BIN_DIR "/lilo";
  std::vector<std::string> words{lilo, "listen", "--port", port, "--count", "3", "--timeout", "10"};
  ChildProcess table(words);
  add_sink(lilod, "127.0.0.1:" + port);
  const Turning turning(lilod);
  EXPECT_EQ(table.wait(seconds(20)), 0) << table.standard_error();
  EXPECT_NE(table.standard_output().find("roll deg"), std::string::npos);
  words.insert(words.end(), {"--json", "--tum", tum.path()});
  const Finished lines = run_to_end(words);
  EXPECT_EQ(lines.exit_code, 0) << lines.error;
  EXPECT_EQ(poses_in(lines.output), 3U);
  std::ifstream file(tum.path());
  std::size_t rows = 0;
  for (std::string line; std::getline(file, line); ++rows) {
    std::istringstream columns(line);
    EXPECT_EQ(std::distance(std::istream_iterator<double>(columns), {}), 8) << line;
  }
  EXPECT_EQ(rows, 3U);
}

TEST(FlatJson, AgreesWithAParserOnGoodAndBad) {
  const std::string good = R"( {"a":{"b":[1,-2.5e3,{"c":"x\"y"}],"d":{}},"e":[],"f":true} )";
  const FlatJson flat(good);
  EXPECT_TRUE(flat.good());
  EXPECT_EQ(flat.number("a/b/1"), -2500.0);
  EXPECT_EQ(flat.text("a/b/2/c"), "x\"y");
  EXPECT_EQ(flat.text("f"), "true");
  EXPECT_FALSE(flat.has("e/0"));
  for (std::size_t k = 0; k + 2 < good.size(); ++k) {
    const std::string cut = good.substr(0, k);
    EXPECT_FALSE(FlatJson(cut).good()) << cut;
  }
  const std::string deep(2000, '[');
  EXPECT_FALSE(FlatJson(deep).good());
}

}  // namespace
}  // namespace lilo
