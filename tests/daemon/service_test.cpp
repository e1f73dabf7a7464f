// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/conversation.hpp"

#include <cmath>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

/// The daemon through what befalls it, seen from outside.
namespace lilo {
namespace {

TEST(Reload, TakesWhatCanChangeAndNamesTheRest) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket other;
  lilod.change_config(lilod.sink().endpoint() + "\"]",
                      other.endpoint() + "\"]\n  frame_id: elsewhere");
  ASSERT_TRUE(lilod.systemd().wait_for("RELOADING=1", seconds(10)));
  ASSERT_TRUE(lilod.systemd().wait_for("READY=1", seconds(10)));
  EXPECT_TRUE(next_of_kind(other, "health")) << "the new sink";
  EXPECT_EQ(lilod.stop(), 0);
  const std::string log = lilod.process().standard_error();
  EXPECT_NE(log.find("publish.sinks is now"), std::string::npos) << log;
  EXPECT_NE(log.find("publish.frame_id: \"elsewhere\" needs a restart"), std::string::npos) << log;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

TEST(Log, ItsLevelChangesWhileItRuns) {
  Lilod lilod("log:\n  level: error\n");
  ASSERT_TRUE(lilod.wait_ready());
  EXPECT_EQ(lilod.process().standard_error(), "");
  lilod.change_config("level: error", "level: info");
  ASSERT_TRUE(lilod.systemd().wait_for("READY=1", seconds(10)));
  EXPECT_EQ(lilod.stop(), 0);
  EXPECT_EQ(count(lilod.process().standard_error(), "stopping on signal"), 1U);
}

// Whoever can make it log cannot fill the disk: a hundred reloads of a bad file.
TEST(Log, RepeatsAreLeftOutAndCounted) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  lilod.change_config("publish:", "publisch:");
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(lilod.systemd().wait_for("READY=1", seconds(10)));
    lilod.process().signal(SIGHUP);
  }
  const std::string log = lilod.process().standard_error();
  EXPECT_GE(count(log, "did you mean publish?"), 3U);
  EXPECT_LE(count(log, "\n"), 150U) << "of 200; 50 in 10 s";
}

TEST(Reload, ABadFileChangesNothing) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  lilod.change_config("publish:", "publisch:");
  ASSERT_TRUE(lilod.systemd().wait_for("READY=1", seconds(10)));
  while (lilod.sink().receive(milliseconds(0))) {
  }
  const json health = next_of_kind(lilod.sink(), "health").value_or(json());
  ASSERT_FALSE(health.is_null()) << "the old sink is still in force";
  EXPECT_NE(health["health"]["complaints"].dump().find("configuration file bad"),
            std::string::npos);
  lilod.change_config("publisch:", "publish:");
  ASSERT_TRUE(lilod.systemd().wait_for("READY=1", seconds(10)));
  EXPECT_EQ(lilod.stop(), 0);
  EXPECT_NE(lilod.process().standard_error().find("did you mean publish?"), std::string::npos);
}

// As it is for a moment while an editor writes it: the sinks stay.
TEST(Reload, AnEmptyFileChangesNothing) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  std::ofstream(lilod.config_path()).close();
  lilod.process().signal(SIGHUP);
  ASSERT_TRUE(lilod.systemd().wait_for("READY=1", seconds(10)));
  while (lilod.sink().receive(milliseconds(0))) {
  }
  EXPECT_TRUE(next_of_kind(lilod.sink(), "health")) << "the old sink is still in force";
  EXPECT_EQ(lilod.stop(), 0);
  const std::string log = lilod.process().standard_error();
  EXPECT_NE(log.find("expected at least one key, found none"), std::string::npos) << log;
}

/// The thread of a process by its name.
pid_t thread_named(pid_t process, const std::string& name) {
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm") >> std::ws, comm);
    if (comm == name) return std::stoi(task.path().filename());
  }
  return -1;
}

// One thread is stopped as a debugger would: scans wait, and systemd hears no more.
TEST(Watchdog, FiresWhenTheWorkerStalls) {
  Lilod lilod("", {{"WATCHDOG_USEC", "400000"}});
  ASSERT_TRUE(lilod.wait_ready());
  Sensor sensor;
  sensor.turn(lilod, 3.0);
  ASSERT_TRUE(lilod.systemd().wait_for("WATCHDOG=1", seconds(10)));
  const pid_t worker = thread_named(lilod.process().pid(), "lilo-worker");
  if (ptrace(PTRACE_SEIZE, worker, nullptr, nullptr) != 0) GTEST_SKIP() << "ptrace is forbidden";
  ptrace(PTRACE_INTERRUPT, worker, nullptr, nullptr);
  waitpid(worker, nullptr, __WALL);
  sensor.turn(lilod, 4.0);
  while (lilod.systemd().wait_for("WATCHDOG=1", milliseconds(450))) {  // the looks under way
  }
  EXPECT_FALSE(lilod.systemd().wait_for("WATCHDOG=1", milliseconds(600)));
  ptrace(PTRACE_DETACH, worker, nullptr, nullptr);
  EXPECT_TRUE(lilod.systemd().wait_for("WATCHDOG=1", seconds(10))) << "it works again";
}

// Sensor off and on: the session goes on, and says so meanwhile.
TEST(Sensor, UnpluggedAndReplugged) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  Sensor().turn_in_step(lilod, 3);
  const json before = next_of_kind(lilod.sink(), "pose").value_or(json());
  const json silent = health_where(lilod.sink(), "status", "silent");
  ASSERT_FALSE(silent.is_null());
  EXPECT_GT(silent["health"]["pose_age_s"], 0.5);
  EXPECT_EQ(silent["health"]["complaints"][0], "sensor silent");
  EXPECT_GE(silent["health"]["sensor_silent_s"], 1.0) << "more than 1 s, in tenths";
  Sensor().turn(lilod, 3.0);  // its clock starts again
  const json after = next_of_kind(lilod.sink(), "pose").value_or(json());
  EXPECT_EQ(after["session"], before["session"]);
  EXPECT_GT(after["seq"], before["seq"]);
}

/// What the daemon has sent its sink: all poses, and the last health with a time after `after_s`.
// NOLINTNEXTLINE(bugprone-exception-escape): nlohmann's move asserts
struct Told {
  std::vector<json> poses;
  json health;
};

/// Reads until there is such a health and nothing more comes.
Told told_after(double after_s, Lilod& lilod) {
  Told told;
  const auto deadline = std::chrono::steady_clock::now() + seconds(30);
  while (std::chrono::steady_clock::now() < deadline) {
    const auto datagram = lilod.sink().receive(milliseconds(300));
    if (!datagram && !told.health.is_null()) break;
    if (!datagram) continue;
    const json message = json::parse(*datagram);
    if (message.contains("pose")) told.poses.push_back(message);
    if (message["timestamp"] > after_s && message.contains("health")) told.health = message;
  }
  return told;
}

// Somebody sets the computer's clock an hour ahead while the sensor turns: the session goes on, and
// no pose jumps, no duration is longer than the test.
TEST(Clock, AStepOfAnHourBendsNothing) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer has to be loaded first";
  const std::string step_file = testing::TempDir() + "lilo_step_" + std::to_string(getpid());
  std::filesystem::remove(step_file);
  const auto began = std::chrono::steady_clock::now();
  Lilod lilod("",
              {{"LD_PRELOAD", LILO_TESTS_DIR "/libstep_clock.so"}, {"STEP_CLOCK_FILE", step_file}});
  ASSERT_TRUE(lilod.wait_ready());
  Sensor sensor;
  sensor.turn_in_step(lilod, 5);
  std::ofstream(step_file) << "now";
  sensor.turn_in_step(lilod, 10);
  const auto [poses, health] = told_after(static_cast<double>(std::time(nullptr)) + 1800.0, lilod);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  std::filesystem::remove(step_file);
  ASSERT_FALSE(health.is_null()) << "the new time is in force";
  ASSERT_GT(poses.size(), 10U);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    EXPECT_EQ(poses[k]["session"], poses[0]["session"]);
    EXPECT_EQ(poses[k]["seq"], k) << "none is missing";
    EXPECT_GT(poses[k]["timestamp"], poses[k - 1]["timestamp"]);
    const json& pose = poses[k]["pose"];
    EXPECT_NE(pose["status"], "lost");
    EXPECT_LT(std::abs(pose["position"]["x"].get<double>()), 0.1) << "it stands";
    EXPECT_LT(pose["latency_ms"], 1000.0);
  }
  EXPECT_EQ(health["health"]["clock_steps"], 1);
  EXPECT_NE(health["health"]["complaints"].dump().find("the computer's clock was set"),
            std::string::npos);
  EXPECT_LT(health["health"]["uptime_s"], took.count());
  EXPECT_LT(health["health"]["sensor_silent_s"], took.count());
}

// kill -9 and a new start: within two seconds a client sees a new session.
TEST(Session, KilledAndStartedAgainItIsANewOneWithinTwoSeconds) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket client;
  const json before = ask(client, lilod, R"({"query":"hello"})", "hello")["session"];
  const auto killed_at = std::chrono::steady_clock::now();
  lilod.process().signal(SIGKILL);
  EXPECT_EQ(lilod.process().wait(seconds(2)), 128 + SIGKILL);
  lilod.restart();
  ASSERT_TRUE(lilod.wait_ready());
  const json after = ask(client, lilod, R"({"query":"hello"})", "hello")["session"];
  EXPECT_LT(std::chrono::steady_clock::now() - killed_at, seconds(2));
  EXPECT_TRUE(after.is_string());
  EXPECT_NE(before, after);
}

// Garbage, oversized requests and ten thousand subscriptions: bounded answers, and poses go on.
TEST(Hostile, ClientsCannotDisturbThePoses) {
  // AddressSanitizer would keep what was freed.
  Lilod lilod("  max_clients: 4\n", {{"ASAN_OPTIONS", "quarantine_size_mb=0"}});
  ASSERT_TRUE(lilod.wait_ready());
  const json calm = next_of_kind(lilod.sink(), "health").value_or(json());
  UdpSocket attacker;
  const std::string huge = R"({"subscribe":{},"x":")" + std::string(60000, 'x') + "\"}";
  std::mt19937 rng(3);
  for (int k = 0; k < 10'000; ++k) {
    std::string garbage(static_cast<std::size_t>(rng() % 600), '\0');
    for (char& c : garbage) c = static_cast<char>(rng());
    attacker.send_to(lilod.server_port(), k % 100 == 0 ? huge : garbage);
    attacker.send_to(lilod.server_port(), R"({"subscribe":{}})");
  }
  std::vector<std::unique_ptr<UdpSocket>> crowd;
  for (int k = 0; k < 50; ++k) {
    crowd.push_back(std::make_unique<UdpSocket>());
    crowd.back()->send_to(lilod.server_port(), R"({"subscribe":{}})");
  }
  Sensor().turn(lilod, 5.0);
  EXPECT_TRUE(next_of_kind(lilod.sink(), "pose"));
  const json health = next_of_kind(lilod.sink(), "health").value_or(json());
  EXPECT_LE(health["health"]["clients"], 4);
  EXPECT_EQ(health["health"]["packets"]["lost"], 0);
  const auto resident_mb = [](const json& h) {
    return h["health"]["realtime"]["resident_mb"].get<double>();
  };
  if (!kUnderTsan) {
    EXPECT_LT(resident_mb(health), resident_mb(calm) + 16.0)
        << "a map has begun, nothing else grew";
  }
  int answers = 0;
  while (attacker.receive(milliseconds(0))) ++answers;
  EXPECT_LT(answers, 1000) << "20 000 requests in a moment";
  EXPECT_EQ(lilod.stop(), 0) << lilod.process().standard_error();
}

}  // namespace
}  // namespace lilo
