// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/operator.hpp"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <map>
#include <poll.h>
#include <pty.h>
#include <sstream>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

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

/// `lilo top` on a terminal of its own.
class TopOnATerminal {
 public:
  TopOnATerminal(const std::vector<std::string>& words, unsigned short rows,
                 unsigned short columns) {
    winsize window{.ws_row = rows, .ws_col = columns};
    pid_ = forkpty(&fd_, nullptr, nullptr, &window);
    if (pid_ != 0) return;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    setenv("TERM", "xterm", 1);
    unsetenv("NO_COLOR");
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  ~TopOnATerminal() {
    kill(pid_, SIGKILL);
    close(fd_);
    waitpid(pid_, nullptr, 0);
  }
  TopOnATerminal(const TopOnATerminal&) = delete;
  TopOnATerminal& operator=(const TopOnATerminal&) = delete;

  /// Everything it has written, once that holds `text`; or after ten seconds.
  std::string until(const std::string& text) {
    const auto deadline = std::chrono::steady_clock::now() + seconds(10);
    while (written_.find(text) == std::string::npos &&
           std::chrono::steady_clock::now() < deadline) {
      pollfd waiting{fd_, POLLIN, 0};
      if (poll(&waiting, 1, 200) <= 0) continue;
      std::array<char, 4096> bytes{};
      const ssize_t size = read(fd_, bytes.data(), bytes.size());
      if (size <= 0) break;
      written_.append(bytes.data(), static_cast<std::size_t>(size));
    }
    return written_;
  }
  /// All of it, and what it is still writing.
  void forget() {
    std::array<char, 65536> bytes{};
    pollfd waiting{fd_, POLLIN, 0};
    while (poll(&waiting, 1, 0) > 0 && read(fd_, bytes.data(), bytes.size()) > 0) {
    }
    written_.clear();
  }
  void press(char key) const { EXPECT_EQ(write(fd_, &key, 1), 1); }
  void resize(unsigned short rows, unsigned short columns) const {
    const winsize window{.ws_row = rows, .ws_col = columns};
    EXPECT_EQ(ioctl(fd_, TIOCSWINSZ, &window), 0);
  }
  /// The exit code.
  [[nodiscard]] int wait() const {
    int status = 0;
    for (int k = 0; k < 100; ++k) {
      if (waitpid(pid_, &status, WNOHANG) == pid_)
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      std::this_thread::sleep_for(milliseconds(50));
    }
    return -2;
  }

 private:
  int fd_ = -1;
  pid_t pid_ = -1;
  std::string written_;
};

TEST_F(Follower, TopFollowsTheWindowAndRestoresTheTerminal) {
  const Turning turning(lilod);
  constexpr char kCtrlC = 3;
  for (const char key : {'q', kCtrlC}) {
    TopOnATerminal top(words({"top"}), 40, 100);
    const std::string screen = top.until("Processing");
    EXPECT_NE(screen.find("\033[?1049h"), std::string::npos);
    EXPECT_NE(screen.find("Processing"), std::string::npos) << screen;
    top.resize(5, 100);
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
