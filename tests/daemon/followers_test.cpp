// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/on_a_terminal.hpp"
#include "tests/daemon/operator.hpp"

#include <csignal>
#include <map>
#include <sstream>

/// What goes along with a running daemon: record, listen, top, the ROS 2 package.
namespace lilo {
namespace {

class Follower : public Operator {};

TEST_F(Follower, RecordsJsonLinesAndTum) {
  const Turning turning(lilod);
  const std::string lines = unique_path("a.jsonl"), tum = unique_path("a.tum");
  const Finished first = run({"record", lines, "--count", "5"});
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_EQ(first.output.rfind(lines + ": 5 poses", 0), 0U) << first.output;
  EXPECT_EQ(poses_in(text_of(lines)), 5U);
  ASSERT_EQ(run({"record", tum, "--count", "4"}).exit_code, 0);
  const std::string rows = text_of(tum);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 4) << rows;
}

TEST_F(Follower, RecordReplacesNothingUnlessForced) {
  const Turning turning(lilod);
  const TemporaryFile file("there.jsonl", "precious");
  const Finished refused = run({"record", file.path(), "--count", "1"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.error, "lilo: " + file.path() + ": is there already (--force replaces it)\n");
  EXPECT_EQ(text_of(file.path()), "precious");
  EXPECT_EQ(run({"record", file.path(), "--count", "1", "--force"}).exit_code, 0);
}

// Ctrl-C ends an MCAP file in good order.
TEST_F(Follower, RecordEndsWithCtrlC) {
  const Turning turning(lilod);
  const std::string path = unique_path("b.mcap");
  ChildProcess recorder(words({"record", path}));
  std::this_thread::sleep_for(seconds(2));
  recorder.signal(SIGINT);
  EXPECT_EQ(recorder.wait(seconds(10)), 0) << recorder.standard_error();
  const std::string bytes = text_of(path);
  ASSERT_GT(bytes.size(), 16U);
  EXPECT_EQ(bytes.substr(0, 8), "\x89MCAP0\r\n");
  EXPECT_EQ(bytes.substr(bytes.size() - 8), "\x89MCAP0\r\n");
}

// The sink's port is another listener's: the second one subscribes and says so.
TEST_F(Follower, ListenSubscribesWhenThePortIsTaken) {
  const Turning turning(lilod);
  const Finished listened =
      run_to_end({kLilo, "listen", "--port", std::to_string(lilod.sink().port()), "--request-port",
                  std::to_string(lilod.server_port()), "--count", "3"});
  EXPECT_EQ(listened.exit_code, 0) << listened.error;
  EXPECT_NE(listened.error.find("is another program's: subscribing to 127.0.0.1:"),
            std::string::npos)
      << listened.error;
  EXPECT_NE(listened.output.find("roll deg"), std::string::npos);
}

TEST_F(Follower, TopFollowsTheWindowAndRestoresTheTerminal) {
  const Turning turning(lilod);
  for (const std::string key : {"q", "\x03"}) {  // or Ctrl-C
    OnATerminal top(words({"top"}), {.rows = 40, .columns = 100});
    const std::string screen = top.until("Processing");
    EXPECT_NE(screen.find("\033[?1049h"), std::string::npos);
    EXPECT_NE(screen.find("Processing"), std::string::npos) << screen;
    top.resize({.rows = 5, .columns = 100});
    std::this_thread::sleep_for(milliseconds(600));
    top.forget();
    const std::string small = top.until("ends");
    EXPECT_EQ(small.find("Processing"), std::string::npos) << small;
    top.press(key);
    EXPECT_NE(top.until("\033[?1049l").find("\033[?25h\033[?1049l"), std::string::npos);
    EXPECT_EQ(top.wait(), 0);
  }
}

TEST_F(Follower, TopWantsATerminal) {
  const Finished top = run({"top"});
  EXPECT_EQ(top.exit_code, 1);
  EXPECT_EQ(top.error, "lilo: top: expected a terminal; lilo status --json is for programs\n");
}

// The ROS 2 bridge, with stand-ins for ROS: what it publishes is what the daemon sent.
TEST_F(Follower, TheRos2BridgePublishesWhatTheDaemonSends) {
  const std::string python = "/usr/bin/python3";
  if (!std::filesystem::exists(python)) GTEST_SKIP() << python << " is not here";
  const std::string program =
      "import sys; sys.path[:0] = ['" LILO_ROS2_DIR "', '" LILO_CLIENTS_DIR "', '" LILO_CLIENTS_DIR
      "/ros2/lilo_ros']\n"
      "import stand_ins; stand_ins.PRINT = True; stand_ins.PARAMETERS['port'] = " +
      std::to_string(lilod.server_port()) + "\nstand_ins.PARAMETERS['continuous'] = False" +
      "\nfrom lilo_ros import bridge; bridge.Bridge().run()\n";
  ChildProcess bridge({python, "-B", "-c", program});
  std::map<std::string, json> sent;  // by stamp
  {
    const Turning turning(lilod);
    for (int k = 0; k < 30; ++k) {
      const auto message = next_of_kind(lilod.sink(), "pose");
      ASSERT_TRUE(message);
      sent[(*message)["pose"]["stamp"].dump()] = *message;
    }
  }
  bridge.signal(SIGTERM);
  bridge.wait(seconds(10));
  std::istringstream lines(bridge.standard_output());
  std::size_t odometries = 0;
  for (std::string line; std::getline(lines, line);) {
    const json published = json::parse(line);
    if (!published.contains("odom")) continue;
    const json& odom = published["odom"];
    const json stamp{{"sec", odom["header"]["stamp"]["sec"]},
                     {"nsec", odom["header"]["stamp"]["nanosec"]}};
    const auto found = sent.find(stamp.dump());
    if (found == sent.end()) continue;
    ++odometries;
    const json& pose = found->second["pose"];
    EXPECT_NE(pose["status"], "lost");
    EXPECT_NE(pose["status"], "initializing");
    EXPECT_EQ(odom["pose"]["pose"]["position"]["x"], pose["position"]["x"]);
    EXPECT_EQ(odom["child_frame_id"], pose["child_frame_id"]);
  }
  EXPECT_GT(odometries, 5U) << bridge.standard_error();
}

}  // namespace
}  // namespace lilo
