// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pose_message.hpp"
#include "tests/daemon/child_process.hpp"
#include "tests/daemon/sockets.hpp"
#include "tools/clients/lilo_client.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <clocale>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>

/// What the clients we give away make of a pose whose every number is another.
namespace lilo {
namespace {

using nlohmann::json;

const std::string kPython = "/usr/bin/python3";

// Every number is another.
Estimate an_estimate() {
  Estimate e;
  e.stamp_ns = 1'700'000'000'250'000'000;
  e.T_odom_sensor = {
      Eigen::Quaterniond(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitZ())),
      {1.0, 2.0, 3.0}};
  e.status = TrackingStatus::degraded;
  e.twist = {{4.0, 5.0, 6.0}, {0.1, 0.2, 0.3}};
  e.has_covariance = true;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      e.covariance(row, column) = 1.0 + 0.1 * row + 0.01 * column;
  e.weak_count = 2;
  e.weak_directions[0].direction << 0.6, 0.0, 0.0, 0.0, 0.0, -0.8;
  e.weak_directions[0].from_scan = 0.25;
  e.weak_directions[1].direction << 0.0, 1.0, 0.0, 0.0, 0.0, 0.0;
  e.weak_directions[1].from_scan = 0.5;
  return e;
}

/// Sends one datagram to whoever asks.
class OneAnswerServer {
 public:
  explicit OneAnswerServer(std::string answer)
      : thread_([this, answer = std::move(answer)] {
          while (!stop_) {
            if (socket_.receive(std::chrono::milliseconds(50)))
              socket_.send_to(socket_.sender(), answer);
          }
        }) {}
  ~OneAnswerServer() {
    stop_ = true;
    thread_.join();
  }
  OneAnswerServer(const OneAnswerServer&) = delete;
  OneAnswerServer& operator=(const OneAnswerServer&) = delete;
  [[nodiscard]] std::uint16_t port() const { return socket_.port(); }

 private:
  UdpSocket socket_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Sends the same pose to whoever asks.
class OnePoseServer : public OneAnswerServer {
 public:
  explicit OnePoseServer(const Estimate& estimate) : OneAnswerServer(written(estimate)) {}

 private:
  static std::string written(const Estimate& estimate) {
    JsonWriter out;
    const PoseMessageContext context{"0123456789abcdef", "odom", "velodyne"};
    return std::string(write_pose(context, {.estimate = estimate, .seq = 7}, 2'000'000, out));
  }
};

TEST(ClientFields, CppClientReadsCovarianceAndWeakDirections) {
  const Estimate e = an_estimate();
  const OnePoseServer server(e);
  Client client("127.0.0.1", server.port());
  ClientPose pose;
  ASSERT_TRUE(client.next(pose));
  EXPECT_EQ(pose.seq, 7U);
  EXPECT_EQ(pose.status, "degraded");
  ASSERT_TRUE(pose.has_covariance);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column)
      EXPECT_DOUBLE_EQ(pose.covariance[static_cast<std::size_t>(6 * row + column)],
                       1.0 + 0.1 * row + 0.01 * column);
  }
  ASSERT_EQ(pose.weak_directions.size(), 2U);
  EXPECT_EQ(pose.weak_directions[0].direction, (std::array<double, 6>{0.6, 0, 0, 0, 0, -0.8}));
  EXPECT_EQ(pose.weak_directions[0].from_scan, 0.25);
  EXPECT_EQ(pose.weak_directions[1].from_scan, 0.5);
}

// The same object goes on to the next pose, which has neither.
TEST(ClientFields, WhatIsNotSaidIsNotThere) {
  ClientPose pose;
  {
    const OnePoseServer server(an_estimate());
    Client client("127.0.0.1", server.port());
    ASSERT_TRUE(client.next(pose));
  }
  Estimate e = an_estimate();
  e.has_covariance = false;
  e.weak_count = 0;
  e.status = TrackingStatus::lost;
  const OnePoseServer server(e);
  Client client("127.0.0.1", server.port());
  ASSERT_TRUE(client.next(pose));
  EXPECT_FALSE(pose.has_covariance);
  EXPECT_FALSE(pose.has_twist) << "nobody measured it";
  EXPECT_TRUE(pose.weak_directions.empty());
}

/// Why the C++ client has no pose from this server.
std::string why_none(std::uint16_t port) {
  Client client("127.0.0.1", port);
  ClientPose pose;
  EXPECT_FALSE(client.next(pose, std::chrono::milliseconds(300)));
  return client.why();
}

// 38.172 is not 38, whatever the program's locale says.
TEST(ClientFields, CppClientReadsNumbersUnderEveryLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const char* german = std::setlocale(LC_ALL, "de_DE.UTF-8");
  const std::string text = R"({"a":38.172,"b":"38,172","c":-1.5e-3})";
  const FlatJson flat(text);
  EXPECT_EQ(flat.number("a"), 38.172) << (german == nullptr ? "no German locale here" : german);
  EXPECT_EQ(flat.number("c"), -0.0015);
  EXPECT_TRUE(std::isnan(flat.number("b"))) << "no number";
  EXPECT_TRUE(std::isnan(flat.number("d"))) << "not there";
  std::setlocale(LC_ALL, before.c_str());
  std::ifstream header(LILO_CLIENTS_DIR "/lilo_client.hpp");
  const std::string source(std::istreambuf_iterator<char>(header), {});
  for (const char* by_locale : {"strtod(", "atof(", "stod(", "sscanf("})
    EXPECT_EQ(source.find(by_locale), std::string::npos) << by_locale;
}

TEST(ClientFields, CppClientSaysWhyThereIsNoPose) {
  EXPECT_NE(why_none(free_udp_port()).find("nobody listens there"), std::string::npos);
  const UdpSocket silent;
  EXPECT_NE(why_none(silent.port()).find("within 300 ms: no answer"), std::string::npos);
  const OneAnswerServer refuses(R"({"v":"2.0","error":{"reason":"too many clients"}})");
  EXPECT_NE(why_none(refuses.port()).find("it refuses: too many clients"), std::string::npos);
  const OneAnswerServer waits(R"({"v":"2.7","health":{"status":"silent"},"new":1})");
  EXPECT_NE(why_none(waits.port()).find("its health is silent"), std::string::npos);
  const OneAnswerServer poor(R"({"v":"2.0","seq":1,"pose":{"status":"tracking"}})");
  EXPECT_NE(why_none(poor.port()).find("numbers missing"), std::string::npos);
  const OneAnswerServer other(R"({"v":"3.0","seq":1,"pose":{"status":"tracking"}})");
  EXPECT_NE(why_none(other.port()).find("speaks protocol 3.0, this client reads 2.x"),
            std::string::npos);
}

TEST(ClientFields, CppClientTellsANewSession) {
  const OnePoseServer server(an_estimate());
  Client client("localhost", server.port());
  ClientPose pose;
  ASSERT_TRUE(client.next(pose)) << client.why();
  EXPECT_TRUE(pose.new_session) << "the first";
  EXPECT_EQ(pose.stamp_ns, 1'700'000'000'250'000'000);
  ASSERT_TRUE(client.next(pose)) << client.why();
  EXPECT_FALSE(pose.new_session);
}

/// The output of Python code that has the client's module and the server's port.
Finished python(const std::string& code, std::uint16_t port) {
  const std::string script =
      "import sys; sys.path.insert(0, sys.argv[1]); port = int(sys.argv[2])\n"
      "from lilo_client import *\n" +
      code;
  return run_to_end({kPython, "-c", script, LILO_CLIENTS_DIR, std::to_string(port)});
}

TEST(ClientFields, PythonClientSaysWhyThereIsNoPose) {
  if (!std::filesystem::exists(kPython)) GTEST_SKIP() << kPython << " is not here";
  const std::string code = "c = LiloClient(port=port); print(list(c.poses(0.3))); print(c.why)";
  EXPECT_NE(python(code, free_udp_port()).output.find("nobody listens there"), std::string::npos);
  const OneAnswerServer refuses(R"({"v":"2.0","error":{"reason":"too many clients"}})");
  const Finished refused = python(code, refuses.port());
  EXPECT_NE(refused.output.find("it refuses: too many clients"), std::string::npos)
      << refused.output << refused.error;
  const OneAnswerServer waits(R"({"v":"2.7","health":{"status":"silent"},"new":1})");
  const Finished waited = python(code, waits.port());
  EXPECT_NE(waited.output.find("its health is silent"), std::string::npos)
      << waited.output << waited.error;
  const OneAnswerServer other(R"({"v":"3.0","seq":1,"pose":{"status":"tracking"}})");
  EXPECT_NE(python(code, other.port()).error.find("speaks protocol 3.0, this client reads 2.x"),
            std::string::npos);
}

TEST(ClientFields, PythonClientHandsOnTheProtocol) {
  if (!std::filesystem::exists(kPython)) GTEST_SKIP() << kPython << " is not here";
  const OnePoseServer server(an_estimate());
  const std::string script =
      "import sys, json; sys.path.insert(0, sys.argv[1]); from lilo_client import LiloClient; "
      "print(json.dumps(next(LiloClient(port=int(sys.argv[2])).poses(10))))";
  const Finished run =
      run_to_end({kPython, "-c", script, LILO_CLIENTS_DIR, std::to_string(server.port())});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const json pose = json::parse(run.output);
  EXPECT_EQ(pose["seq"], 7);
  EXPECT_EQ(pose["covariance"].size(), 36U);
  EXPECT_EQ(pose["covariance"][6 * 2 + 5], 1.25);
  EXPECT_EQ(pose["weak_directions"][0]["direction"], json({0.6, 0, 0, 0, 0, -0.8}));
}

}  // namespace
}  // namespace lilo
