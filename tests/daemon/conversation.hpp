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

/// A VLP-16 in a round room, three times as fast as life, or slower than life under a sanitizer.
/// Its clock goes on from turn to turn.
class Sensor {
 public:
  void turn(const Lilod& lilod, double turns) {
    PacketView packet;
    for (double sent = 0.0; sent < turns * RoundRoomSource::kPacketsPerTurn; sent += 1.0) {
      source_.read(packet, milliseconds(0));
      const auto* bytes = reinterpret_cast<const char*>(packet.payload.data());
      socket_.send_to(lilod.data_port(), std::string(bytes, packet.payload.size()));
      std::this_thread::sleep_for(std::chrono::microseconds(kSanitized ? 3000 : 400));
    }
  }
  void be_in_a_room_of(unsigned radius_m) { source_.be_in_a_room_of(radius_m); }

 private:
  RoundRoomSource source_{1'000'000};
  UdpSocket socket_;
};

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

}  // namespace lilo
