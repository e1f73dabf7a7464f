#include "tests/daemon/conversation.hpp"

#include <arpa/inet.h>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <ifaddrs.h>
#include <map>
#include <poll.h>
#include <pty.h>
#include <sstream>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

/// What an operator does to a running daemon: status, top, record, reset, save, listen, doctor.
namespace lilo {
namespace {

const std::string kLilo = LILO_BIN_DIR "/lilo";

/// Turns the sensor until the object goes.
class Turning {
 public:
  explicit Turning(const Lilod& lilod)
      : thread_([this, &lilod] {
          Sensor sensor;
          while (!stop_) sensor.turn(lilod, 0.5);
        }) {}
  ~Turning() {
    stop_ = true;
    thread_.join();
  }
  Turning(const Turning&) = delete;
  Turning& operator=(const Turning&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

std::string new_path(const char* name) {
  static std::atomic<int> next{0};
  return testing::TempDir() + "operators_" + std::to_string(getpid()) + '_' +
         std::to_string(next++) + '_' + name;
}

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class Operator : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(lilod.wait_ready()); }

  [[nodiscard]] std::vector<std::string> words(std::vector<std::string> command) const {
    command.insert(command.begin(), kLilo);
    command.insert(command.end(), {"--port", std::to_string(lilod.server_port())});
    return command;
  }
  [[nodiscard]] Finished run(const std::vector<std::string>& command) const {
    return run_to_end(words(command));
  }
  /// Until the daemon tracks and has nothing to complain of, or not.
  [[nodiscard]] bool becomes_good() const {
    const auto deadline = std::chrono::steady_clock::now() + seconds(20);
    while (std::chrono::steady_clock::now() < deadline) {
      if (run({"status"}).exit_code == 0) return true;
      std::this_thread::sleep_for(milliseconds(200));
    }
    return false;
  }

  std::string state = new_path("state");
  Lilod lilod{"state:\n  directory: " + (std::filesystem::create_directories(state), state) + '\n'};
};

TEST_F(Operator, StatusIsBadWithoutASensor) {
  std::this_thread::sleep_for(milliseconds(2500));
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

TEST_F(Operator, RecordsJsonLinesAndTum) {
  const Turning turning(lilod);
  const std::string lines = new_path("a.jsonl"), tum = new_path("a.tum");
  const Finished first = run({"record", lines, "--count", "5"});
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_EQ(first.output.rfind(lines + ": 5 poses", 0), 0U) << first.output;
  std::istringstream text(text_of(lines));
  std::size_t poses = 0;
  for (std::string line; std::getline(text, line);) {
    const json message = json::parse(line);
    EXPECT_EQ(violations(protocol_schema(), message), std::vector<std::string>{});
    poses += message.contains("pose") ? 1 : 0;
  }
  EXPECT_EQ(poses, 5U);
  ASSERT_EQ(run({"record", tum, "--count", "4"}).exit_code, 0);
  const std::string rows = text_of(tum);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 4) << rows;
}

TEST_F(Operator, RecordReplacesNothingUnlessForced) {
  const Turning turning(lilod);
  const TemporaryFile file("there.jsonl", "precious");
  const Finished refused = run({"record", file.path(), "--count", "1"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.error, "lilo: " + file.path() + ": is there already (--force replaces it)\n");
  EXPECT_EQ(text_of(file.path()), "precious");
  EXPECT_EQ(run({"record", file.path(), "--count", "1", "--force"}).exit_code, 0);
}

// Ctrl-C ends an MCAP file in good order.
TEST_F(Operator, RecordEndsWithCtrlC) {
  const Turning turning(lilod);
  const std::string path = new_path("b.mcap");
  ChildProcess recorder(words({"record", path}));
  std::this_thread::sleep_for(seconds(2));
  recorder.signal(SIGINT);
  EXPECT_EQ(recorder.wait(seconds(10)), 0) << recorder.standard_error();
  const std::string bytes = text_of(path);
  ASSERT_GT(bytes.size(), 16U);
  EXPECT_EQ(bytes.substr(0, 8), "\x89MCAP0\r\n");
  EXPECT_EQ(bytes.substr(bytes.size() - 8), "\x89MCAP0\r\n");
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

// The sink's port is another listener's: the second one subscribes and says so.
TEST_F(Operator, ListenSubscribesWhenThePortIsTaken) {
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

std::optional<std::string> outer_address() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return std::nullopt;
  std::optional<std::string> out;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
    if (std::string(text.data()).rfind("127.", 0) != 0) out = text.data();
  }
  freeifaddrs(all);
  return out;
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
  const std::string path = new_path("c.jsonl");
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

TEST_F(Operator, TopFollowsTheWindowAndRestoresTheTerminal) {
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

TEST_F(Operator, TopWantsATerminal) {
  const Finished top = run({"top"});
  EXPECT_EQ(top.exit_code, 1);
  EXPECT_EQ(top.error, "lilo: top: expected a terminal; lilo status --json is for programs\n");
}

// The ROS 2 bridge, with stand-ins for ROS: what it publishes is what the daemon sent.
TEST_F(Operator, TheRos2BridgePublishesWhatTheDaemonSends) {
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
  RoundRoomSource source(1'000'000);
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

/// What bash offers for a command line, by the script that is shipped.
std::string completions(const std::string& line_words, int at) {
  const TemporaryFile script("complete.sh",
                             "source <(" + kLilo + " completion bash)\nlilo() { " + kLilo +
                                 " \"$@\"; }\nCOMP_WORDS=(" + line_words +
                                 ")\nCOMP_CWORD=" + std::to_string(at) +
                                 "\ncompopt() { :; }\n_lilo\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
  return run_to_end({"/bin/bash", script.path()}).output;
}

TEST(Completion, BashOffersCommandsOptionsAndChoices) {
  EXPECT_EQ(completions("lilo sta", 1), "status\n");
  EXPECT_EQ(completions("lilo status --j", 2), "--json\n");
  EXPECT_EQ(completions("lilo save ''", 2), "map\ntrajectory\n");
}

}  // namespace
}  // namespace lilo
