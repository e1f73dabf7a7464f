// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/player.hpp"

#include <boost/asio/buffer.hpp>
#include <gtest/gtest.h>

#include <poll.h>
#include <stdexcept>
#include <vector>

namespace lilo {
namespace {

using boost::asio::ip::udp;
using Payload = std::vector<std::byte>;

/// Packets 1 us apart: data packets, but every fourth is a position packet.
class MadePackets : public PacketSource {
 public:
  MadePackets(int count, std::uint16_t data_port) : count_(count), data_port_(data_port) {}

  ReadResult read(PacketView& packet, std::chrono::milliseconds) override {
    if (next_ == count_) return ReadResult::end;
    const bool position = next_ % 4 == 3;
    payload_.assign(position ? 512 : 1206, static_cast<std::byte>(next_));
    packet = {.received_ns = next_ * 1000L,
              .destination_port = position ? std::uint16_t{8308} : data_port_,
              .payload = payload_};
    ++next_;
    return ReadResult::packet;
  }
  [[nodiscard]] SourceCounts counts() const override { return {}; }

 private:
  int count_, next_ = 0;
  std::uint16_t data_port_;
  Payload payload_;
};

/// A socket on a free port of the loopback interface.
class Receiver {
 public:
  [[nodiscard]] std::uint16_t port() const { return socket_.local_endpoint().port(); }

  /// The next datagram; empty when none is left.
  Payload receive() {
    pollfd waiting{socket_.native_handle(), POLLIN, 0};
    if (poll(&waiting, 1, 1000) <= 0) return {};
    Payload payload(2000);
    payload.resize(socket_.receive(boost::asio::buffer(payload)));
    return payload;
  }

 private:
  boost::asio::io_context io_;
  udp::socket socket_{io_, {boost::asio::ip::address_v4::loopback(), 0}};
};

bool always(const ReplayCounts&) { return true; }

TEST(Player, SendsEveryPayloadUnchangedAndInOrderToThePortsAskedFor) {
  Receiver data, position;
  MadePackets source(40, 2368);
  Player player({.data_port = data.port(), .position_port = position.port()});
  EXPECT_TRUE(player.play(source, always));
  EXPECT_EQ(player.counts().packets, 40U);
  EXPECT_EQ(player.counts().bytes, 30U * 1206 + 10U * 512);
  for (int k = 0; k < 40; ++k) {
    const bool is_position = k % 4 == 3;
    const Payload expected(is_position ? 512 : 1206, static_cast<std::byte>(k));
    EXPECT_EQ((is_position ? position : data).receive(), expected) << "packet " << k;
  }
}

TEST(Player, UsesTheCapturesPortWhereNoneIsAsked) {
  Receiver data, position;
  MadePackets source(2, data.port());
  Player player({.position_port = position.port()});
  EXPECT_TRUE(player.play(source, always));
  EXPECT_EQ(data.receive().size(), 1206U);
  EXPECT_EQ(data.receive().size(), 1206U);
}

TEST(Player, StopsWhenAsked) {
  Receiver data;
  MadePackets source(100, data.port());
  Player player({.position_port = data.port()});
  EXPECT_FALSE(player.play(source, [](const ReplayCounts& counts) { return counts.packets < 7; }));
  EXPECT_EQ(player.counts().packets, 7U);
}

TEST(Player, SaysWhichHostItDoesNotKnow) {
  try {
    const Player player({.host = "not..a..host"});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("not..a..host"), std::string::npos);
  }
}

}  // namespace
}  // namespace lilo
