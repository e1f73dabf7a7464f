// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/operator.hpp"

#include <algorithm>
#include <filesystem>

/// What an operator asks and tells a running daemon: status, reset, save, doctor.
namespace lilo {
namespace {

TEST_F(Operator, StatusIsBadWithoutASensor) {
  ASSERT_FALSE(health_where(lilod.sink(), "status", "silent").is_null());
  const Finished status = run({"status"});
  EXPECT_EQ(status.exit_code, 1);
  EXPECT_NE(status.output.find("silent"), std::string::npos) << status.output;
  EXPECT_EQ(status.error, "");  // the screen has said it
}

TEST_F(Operator, StatusIsGoodWhenItTracks) {
  const Turning turning(lilod);
  ASSERT_TRUE(becomes_good()) << run({"status"}).output;
  const Finished status = run({"status"});
  EXPECT_NE(status.output.find("Status          : tracking\n"), std::string::npos) << status.output;
  EXPECT_NE(status.output.find("Position        : x "), std::string::npos) << status.output;
  EXPECT_EQ(status.output.find('\033'), std::string::npos);  // no colours into a pipe
  const json object = json::parse(run({"status", "--json"}).output);
  EXPECT_EQ(object["good"], true);
  EXPECT_EQ(object["health"]["status"], "tracking");
  EXPECT_TRUE(object["pose"].contains("position"));
}

TEST_F(Operator, NoDaemonIsOneLine) {
  const std::string port = std::to_string(free_udp_port());
  for (const char* command : {"status", "reset"}) {
    const Finished none = run_to_end({kLilo, command, "--port", port});
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_EQ(none.error, "lilo: 127.0.0.1:" + port + ": no lilod listens there\n");
  }
  const Finished nowhere = run_to_end({kLilo, "status", "--host", "no-such-host.invalid"});
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_EQ(nowhere.error.rfind("lilo: no-such-host.invalid: expected a name or an address", 0), 0U)
      << nowhere.error;
}

TEST_F(Operator, ResetBeginsASessionWhereItWasTold) {
  const Turning turning(lilod);
  ASSERT_TRUE(becomes_good());
  const std::string before = json::parse(run({"status", "--json"}).output)["session"];
  const Finished reset = run({"reset", "--pose", "10", "-20", "3"});
  ASSERT_EQ(reset.exit_code, 0) << reset.error;
  json after;
  for (int k = 0; k < 100 && (after.is_null() || after["session"] == before); ++k)
    after = json::parse(run({"status", "--json"}).output);
  ASSERT_NE(after["session"], before);
  ASSERT_TRUE(becomes_good());
  after = json::parse(run({"status", "--json"}).output);
  EXPECT_NEAR(after["pose"]["position"]["y"].get<double>(), -20.0, 1.0);
}

TEST_F(Operator, SaveSaysWhereAndHowMuch) {
  const Turning turning(lilod);
  ASSERT_TRUE(becomes_good());
  for (const auto& [what, file] :
       {std::pair{"map", "/map.pcd"}, {"trajectory", "/trajectory.tum"}}) {
    const Finished saved = run({"save", what});
    ASSERT_EQ(saved.exit_code, 0) << saved.error;
    EXPECT_EQ(saved.output.rfind(state + file + ": ", 0), 0U) << saved.output;
    EXPECT_GT(std::filesystem::file_size(state + file), 0U);
  }
}

TEST_F(Operator, SaveTellsWhatTheDaemonRefuses) {
  Lilod without_state;
  ASSERT_TRUE(without_state.wait_ready());
  const Finished refused =
      run_to_end({kLilo, "save", "map", "--port", std::to_string(without_state.server_port())});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.error.find("no state directory"), std::string::npos) << refused.error;
}

// Another address has to echo the daemon's token first; one that is not allowed hears nothing, and
// is told what to do about it.
TEST(OperatorElsewhere, ShowsTheToken) {
  const auto address = outer_address();
  if (!address) GTEST_SKIP() << "this computer has no address but loopback";
  Lilod lilod("  bind_address: 0.0.0.0\n  allow: [" + *address + "]\n");
  ASSERT_TRUE(lilod.wait_ready());
  const Turning turning(lilod);
  const std::string port = std::to_string(lilod.server_port());
  const std::string path = unique_path("c.jsonl");
  const Finished recorded =
      run_to_end({kLilo, "record", path, "--host", *address, "--port", port, "--count", "5"});
  EXPECT_EQ(recorded.exit_code, 0) << recorded.error;
  EXPECT_NE(run_to_end({kLilo, "status", "--host", *address, "--port", port}).output.find("Status"),
            std::string::npos);
}

TEST(OperatorElsewhere, AStrangerIsToldWhatToDo) {
  const auto address = outer_address();
  if (!address) GTEST_SKIP() << "this computer has no address but loopback";
  Lilod lilod("  bind_address: 0.0.0.0\n");
  ASSERT_TRUE(lilod.wait_ready());
  const Finished refused = run_to_end(
      {kLilo, "status", "--host", *address, "--port", std::to_string(lilod.server_port())});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.error.find(*address + " in subscribe.allow?"), std::string::npos)
      << refused.error;
}

TEST_F(Operator, DoctorAsksTheDaemonThatHasThePort) {
  const Turning turning(lilod);
  ASSERT_TRUE(becomes_good());
  const Finished doctor = run_to_end({kLilo, "doctor", lilod.config_path(), "--seconds", "1"});
  EXPECT_NE(doctor.output.find("the running lilod has had"), std::string::npos) << doctor.output;
}

/// A configuration on free ports.
std::string yaml(std::uint16_t data_port) {
  return "udp:\n  bind_address: 127.0.0.1\n  data_port: " + std::to_string(data_port) +
         "\n  position_port: 0\n";
}

TEST(Doctor, SeesASensorOnTheWire) {
  const std::uint16_t port = free_udp_port();
  const TemporaryFile config("doctor.yaml", yaml(port));
  ChildProcess doctor({kLilo, "doctor", config.path(), "--json"});
  RoomSource source(1'000'000);
  const UdpSocket socket;
  for (std::optional<int> code; !code; code = doctor.wait(milliseconds(5))) {
    PacketView packet;
    source.read(packet, milliseconds(0));
    const auto* bytes = reinterpret_cast<const char*>(packet.payload.data());
    socket.send_to(port, std::string(bytes, packet.payload.size()));
  }
  const json findings = json::parse(doctor.standard_output())["findings"];
  const json packets = *std::find_if(findings.begin(), findings.end(),
                                     [](const json& f) { return f["subject"] == "Packets"; });
  EXPECT_EQ(packets["verdict"], "ok") << packets;
  EXPECT_EQ(packets["text"].get<std::string>().rfind("VLP-16 127.0.0.1: ", 0), 0U) << packets;
}

TEST(Doctor, FailsWithoutOneAndWithABadFile) {
  const TemporaryFile config("doctor.yaml", yaml(free_udp_port()));
  const Finished silent = run_to_end({kLilo, "doctor", config.path(), "--seconds", "0.3"});
  EXPECT_EQ(silent.exit_code, 1);
  EXPECT_NE(silent.output.find("FAIL  Packets"), std::string::npos) << silent.output;
  const TemporaryFile bad("bad.yaml", "udp:\n  port: 1\n");
  const Finished refused = run_to_end({kLilo, "doctor", bad.path()});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("FAIL  Configuration"), std::string::npos) << refused.output;
}

TEST(CommandLine, MistypedCommandsAreSuggested) {
  const Finished mistyped = run_to_end({kLilo, "statsu"});
  EXPECT_EQ(mistyped.exit_code, 2);
  EXPECT_EQ(mistyped.error, "lilo: statsu: no such command, did you mean status? (lilo --help)\n");
}

TEST(CommandLine, VersionHasBuildAndRevision) {
  const std::string version = run_to_end({kLilo, "--version"}).output;
  EXPECT_EQ(version.rfind("lilo " LILO_VERSION " (", 0), 0U) << version;
}

}  // namespace
}  // namespace lilo
