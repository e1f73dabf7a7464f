// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/daemon/lilod_fixture.hpp"
#include "tests/daemon/schema.hpp"
#include "tests/daemon/vlp16_packets.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace lilo {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// The next datagram that has `kind`, within ten seconds or less. All that come are held against
/// the schema.
inline std::optional<json> next_of_kind(UdpSocket& socket, const std::string& kind,
                                        milliseconds patience = seconds(10)) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < deadline) {
    const auto datagram = socket.receive(milliseconds(100));
    if (!datagram) continue;
    json message = json::parse(*datagram);
    EXPECT_LE(datagram->size(), 1200U);
    EXPECT_EQ(violations(protocol_schema(), message), std::vector<std::string>{}) << *datagram;
    if (message.contains(kind)) return message;
  }
  return std::nullopt;
}

/// The poses in a text of one message a line; all lines are held against the schema.
inline std::size_t poses_in(const std::string& json_lines) {
  std::istringstream text(json_lines);
  std::size_t poses = 0;
  for (std::string line; std::getline(text, line);) {
    const json message = json::parse(line);
    EXPECT_EQ(violations(protocol_schema(), message), std::vector<std::string>{}) << line;
    poses += message.contains("pose") ? 1 : 0;
  }
  return poses;
}

/// The first health datagram in which `member` is `value`, of the next fifteen; null if none is.
template <typename Value>
json health_where(UdpSocket& socket, const char* member, const Value& value) {
  for (int k = 0; k < 15; ++k) {
    const auto message = next_of_kind(socket, "health");
    if (message && (*message)["health"][member] == value) return *message;
  }
  return {};
}

inline json ask(UdpSocket& client, const Lilod& lilod, const std::string& request,
                const std::string& kind) {
  client.send_to(lilod.server_port(), request);
  return next_of_kind(client, kind).value_or(json());
}

/// A VLP-16 in a room. Its clock goes on from turn to turn.
class Sensor {
 public:
  /// Three times as fast as life, or slower than life under a sanitizer, whatever the daemon does.
  void turn(const Lilod& lilod, double turns) {
    PacketView packet;
    for (double sent = 0.0; sent < turns * RoomSource::kPacketsPerTurn; sent += 1.0) {
      source_.read(packet, milliseconds(0));
      const auto* bytes = reinterpret_cast<const char*>(packet.payload.data());
      socket_.send_to(lilod.data_port(), std::string(bytes, packet.payload.size()));
      std::this_thread::sleep_for(std::chrono::microseconds(kSanitized ? 3000 : 400));
    }
  }
  /// The same, but each turn waits for the pose of the one before: on a busy computer, too, the
  /// daemon gets no more scans than it can work off.
  void turn_in_step(const Lilod& lilod, int turns) {
    for (int k = 0; k < turns; ++k) {
      turn(lilod, 1.0);
      // The first scan of a sensor ends with its second turn.
      last_pose_ = last_pose_ ? next_pose(lilod) : pose_now(lilod);
    }
  }
  void be_in_a_room_of(double radius_m) { source_.be_in_a_room_of(radius_m); }
  void be_in_a_square_room() { source_.be_in_a_square_room(); }

 private:
  /// As the daemon answers; the same text until it has another pose.
  std::string pose_now(const Lilod& lilod) {
    asks_.send_to(lilod.server_port(), R"({"query":"pose"})");
    return asks_.receive(milliseconds(500)).value_or("");
  }
  /// Not for ever: the daemon may be stopped.
  std::string next_pose(const Lilod& lilod) {
    const auto deadline = std::chrono::steady_clock::now() + seconds(5);
    std::string pose = pose_now(lilod);
    while (pose == last_pose_ && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(milliseconds(20));  // it answers 200 requests a second
      pose = pose_now(lilod);
    }
    return pose;
  }

  RoomSource source_{1'000'000};
  UdpSocket socket_, asks_;
  std::optional<std::string> last_pose_;  ///< nothing before the first turn
};

/// Turns the sensor in a square room, in step with the daemon, until the object goes.
class Turning {
 public:
  explicit Turning(const Lilod& lilod)
      : thread_([this, &lilod] {
          Sensor sensor;
          sensor.be_in_a_square_room();
          while (!stop_) sensor.turn_in_step(lilod, 1);
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

}  // namespace lilo
