// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/conversation.hpp"
#include "tests/daemon/text_of.hpp"

#include <filesystem>
#include <map>
#include <regex>
#include <unistd.h>

namespace lilo {
namespace {

TEST(Protocol, SubscriberGetsPosesUntilItsLeaseEnds) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket client;
  Sensor sensor;
  const json hello = ask(client, lilod, R"({"subscribe":{"ttl_s":1}})", "hello");
  EXPECT_EQ(hello["hello"]["ttl_s"], 1);
  EXPECT_EQ(hello["hello"]["frame_id"], "odom");
  sensor.turn(lilod, 3.0);
  const auto pose = next_of_kind(client, "pose");
  ASSERT_TRUE(pose);
  EXPECT_EQ((*pose)["session"], hello["session"]);
  while (lilod.sink().receive(milliseconds(0))) {  // some are from before it began
  }
  ASSERT_FALSE(health_where(lilod.sink(), "clients", 0).is_null()) << "the lease ends";
  while (client.receive(milliseconds(0))) {
  }
  sensor.turn(lilod, 2.0);
  EXPECT_FALSE(client.receive(milliseconds(300))) << "the lease is over";
  EXPECT_TRUE(next_of_kind(lilod.sink(), "pose")) << "sinks need no lease";
}

TEST(Protocol, UnsubscribeAndQuery) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket client;
  Sensor sensor;
  EXPECT_EQ(ask(client, lilod, R"({"query":"pose"})", "error")["error"]["reason"], "no pose yet");
  ask(client, lilod, R"({"subscribe":{}})", "hello");
  EXPECT_EQ(ask(client, lilod, R"({"unsubscribe":{}})", "hello")["hello"]["ttl_s"], 0);
  sensor.turn(lilod, 3.0);
  ASSERT_TRUE(next_of_kind(lilod.sink(), "pose"));
  EXPECT_FALSE(client.receive(milliseconds(100)));
  EXPECT_TRUE(ask(client, lilod, R"({"query":"pose"})", "pose").contains("pose"));
  EXPECT_TRUE(ask(client, lilod, R"({"query":"health"})", "health").contains("health"));
}

// Who asked gets them with every pose, who did not gets none, and neither does a sink.
TEST(Protocol, PointsGoToThoseWhoAsk) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket looks_on, does_not;
  const json granted =
      ask(looks_on, lilod, R"({"subscribe":{"ttl_s":5,"points":true}})", "hello")["hello"];
  EXPECT_EQ(granted["points"]["scan"], 600);
  EXPECT_FALSE(ask(does_not, lilod, R"({"subscribe":{}})", "hello")["hello"].contains("points"));
  Sensor sensor;
  sensor.turn(lilod, 6.0);
  std::map<std::uint64_t, std::size_t> datagrams_of_pose;
  std::uint64_t last_pose = 0;
  while (const auto datagram = looks_on.receive(milliseconds(500))) {
    EXPECT_LE(datagram->size(), 1200U);
    const json message = json::parse(*datagram);
    EXPECT_EQ(violations(protocol_schema(), message), std::vector<std::string>{});
    if (message.contains("pose")) last_pose = message["seq"];
    if (!message.contains("points")) continue;
    EXPECT_LE(message["seq"], last_pose) << "the pose goes first";
    EXPECT_LT(message["points"]["index"], message["points"]["count"]);
    ++datagrams_of_pose[message["seq"]];
  }
  EXPECT_GE(datagrams_of_pose.size(), 3U);
  for (UdpSocket* socket : {&does_not, &lilod.sink()}) {
    while (const auto datagram = socket->receive(milliseconds(100)))
      EXPECT_FALSE(json::parse(*datagram).contains("points"));
  }
}

TEST(Protocol, PointsCanBeSwitchedOff) {
  Lilod lilod("  points_clients: 0\n");
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket client;
  EXPECT_FALSE(
      ask(client, lilod, R"({"subscribe":{"points":true}})", "hello")["hello"].contains("points"));
  Sensor().turn(lilod, 3.0);
  ASSERT_TRUE(next_of_kind(client, "pose"));
  while (const auto datagram = client.receive(milliseconds(300)))
    EXPECT_FALSE(json::parse(*datagram).contains("points"));
}

// Others use up all of the answers; a lease of one second is renewed for three.
TEST(Protocol, SubscribersRenewWhateverOthersAsk) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket client, crowd;
  ask(client, lilod, R"({"subscribe":{"ttl_s":1}})", "hello");
  for (int round = 0; round < 30; ++round) {
    for (int k = 0; k < 250; ++k) crowd.send_to(lilod.server_port(), R"({"query":"hello"})");
    client.send_to(lilod.server_port(), R"({"subscribe":{"ttl_s":1}})");
    std::this_thread::sleep_for(milliseconds(100));
  }
  while (client.receive(milliseconds(0))) {
  }
  Sensor().turn(lilod, 3.0);
  EXPECT_TRUE(next_of_kind(client, "pose"));
}

// A new session, seq from 0, and the first pose where the client said.
TEST(Protocol, ResetStartsANewSessionAtTheGivenPose) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket client;
  Sensor sensor;
  sensor.turn(lilod, 3.0);
  const json before = next_of_kind(lilod.sink(), "pose").value_or(json());
  while (lilod.sink().receive(milliseconds(100))) {
  }
  const json done = ask(client, lilod,
                        R"({"reset":{"pose":{"position":{"x":10,"y":20,"z":0.5},)"
                        R"("orientation":{"x":0,"y":0,"z":1,"w":0}}}})",
                        "done");
  EXPECT_EQ(done["done"]["request"], "reset");
  EXPECT_TRUE(ask(client, lilod, R"({"reset":{}})", "error").contains("error")) << "under way";
  sensor.turn(lilod, 3.0);
  json after = before;  // poses of scans before the reset may still come
  while (after["session"] == before["session"])
    after = next_of_kind(lilod.sink(), "pose").value_or(json::object());
  ASSERT_TRUE(after.contains("pose"));
  EXPECT_EQ(after["seq"], 0);
  EXPECT_EQ(after["pose"]["position"]["x"], 10);
  EXPECT_EQ(after["pose"]["position"]["y"], 20);
  EXPECT_NEAR(std::abs(after["pose"]["orientation"]["z"].get<double>()), 1.0, 1e-9);
}

// Carried into another room while nobody looked: where the new map lies to the old one only the
// prediction says, so no pose that is aligned with it may pass for one of the old session.
TEST(Protocol, AMapGivenUpIsTheEndOfTheSession) {
  Lilod lilod;
  ASSERT_TRUE(lilod.wait_ready());
  Sensor sensor;
  sensor.turn(lilod, 10.0);
  sensor.be_in_a_room_of(40);
  sensor.turn(lilod, 25.0);
  std::string last_session, session_of_loss;
  std::uint64_t last_seq = 0, aligned_after = 0;
  while (const auto pose = next_of_kind(lilod.sink(), "pose", milliseconds(500))) {
    const std::string session = (*pose)["session"], status = (*pose)["pose"]["status"];
    if (session != last_session) {
      EXPECT_EQ((*pose)["seq"], 0);
    } else {
      EXPECT_EQ((*pose)["seq"], last_seq + 1);
    }
    if (status == "lost") session_of_loss = session;
    const bool aligned = status == "tracking" || status == "degraded";  // round, it may turn
    if (!session_of_loss.empty() && aligned) {
      EXPECT_NE(session, session_of_loss);
      ++aligned_after;
    }
    last_session = session;
    last_seq = (*pose)["seq"];
  }
  EXPECT_FALSE(session_of_loss.empty());
  EXPECT_GT(aligned_after, 0U);
}

TEST(Health, IsSentEverySecondAndSaysWhatIsInForce) {
  Lilod lilod("realtime:\n  worker_cpu: 0\n");
  ASSERT_TRUE(lilod.wait_ready());
  Sensor().turn(lilod, 3.0);
  const json first = next_of_kind(lilod.sink(), "health").value_or(json());
  const json second = next_of_kind(lilod.sink(), "health").value_or(json());
  EXPECT_NEAR(second["timestamp"].get<double>() - first["timestamp"].get<double>(), 1.0, 0.5);
  EXPECT_EQ(second["health"]["packets"]["lost"], 0);
  EXPECT_EQ(second["health"]["scans"]["dropped"], 0);
  EXPECT_EQ(second["health"]["realtime"]["cpus"], "0");
  EXPECT_GT(second["health"]["packets"]["received"], 100);
}

TEST(Metrics, AppearInTheRuntimeDirectory) {
  const std::string folder = testing::TempDir() + "lilo_run_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  {
    Lilod lilod("", {{"RUNTIME_DIRECTORY", folder}});
    ASSERT_TRUE(lilod.wait_ready());
    ASSERT_TRUE(next_of_kind(lilod.sink(), "health"));
    EXPECT_EQ(lilod.stop(), 0);
  }
  const std::string text = text_of(folder + "/lilo.prom");
  const std::regex lost("\nlilo_packets_lost_total\\{instance=\"[^\"]+\"\\} 0\n");
  EXPECT_TRUE(std::regex_search(text, lost)) << text;
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lilo
