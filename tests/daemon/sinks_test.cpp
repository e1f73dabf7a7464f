// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sinks.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/address_v4.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>

namespace lilo {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;

TEST(Sinks, EndpointsAreAddressAndPort) {
  const auto loopback = asio::ip::address_v4::loopback();
  EXPECT_EQ(parse_endpoint("127.0.0.1:9870"), udp::endpoint(loopback, 9870));
  EXPECT_EQ(parse_endpoint("localhost:1"), udp::endpoint(loopback, 1));
  for (const char* bad : {"", ":", "1.2.3.4", "1.2.3.4:", "1.2.3.4:0", "1.2.3.4:65536",
                          "1.2.3.4:9x", "example.org:9870", "1.2.3:9"}) {
    EXPECT_THROW(parse_endpoint(bad), std::invalid_argument) << bad;
  }
}

TEST(Sinks, EverySinkGetsTheWholeDatagram) {
  asio::io_context io;
  udp::socket a(io, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  udp::socket b(io, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  Sinks sinks(io);
  sinks.set({"127.0.0.1:" + std::to_string(a.local_endpoint().port()),
             "localhost:" + std::to_string(b.local_endpoint().port())});
  sinks.send("hello");
  for (udp::socket* socket : {&a, &b}) {
    std::array<char, 100> bytes{};
    const std::size_t size = socket->receive(asio::buffer(bytes));
    EXPECT_EQ(std::string(bytes.data(), size), "hello");
  }
  EXPECT_EQ(sinks.send_errors(), 0U);
}

// A group on the loopback card: whoever joined gets it.
TEST(Sinks, MulticastGroupsAreSinks) {
  asio::io_context io;
  udp::socket member(io, udp::v4());
  member.bind(udp::endpoint(asio::ip::address_v4::any(), 0));
  boost::system::error_code error;
  member.set_option(asio::ip::multicast::join_group(asio::ip::make_address_v4("239.255.98.70")),
                    error);
  if (error) GTEST_SKIP() << "no multicast here: " << error.message();
  Sinks sinks(io);
  sinks.set({"239.255.98.70:" + std::to_string(member.local_endpoint().port())});
  sinks.send("to all");
  ASSERT_EQ(sinks.send_errors(), 0U);
  std::array<char, 100> bytes{};
  EXPECT_EQ(member.receive(asio::buffer(bytes)), 6U);
}

TEST(Sinks, RefusedSendsAreCounted) {
  asio::io_context io;
  Sinks sinks(io);
  sinks.set({"127.0.0.1:9"});
  sinks.send(std::string(70000, 'x'));  // larger than any datagram
  EXPECT_EQ(sinks.send_errors(), 1U);
}

// A bad list changes nothing: the old sinks stay.
TEST(Sinks, BadListIsRefusedWhole) {
  asio::io_context io;
  udp::socket a(io, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  Sinks sinks(io);
  sinks.set({"127.0.0.1:" + std::to_string(a.local_endpoint().port())});
  EXPECT_THROW(sinks.set({"127.0.0.1:1", "nonsense"}), std::invalid_argument);
  sinks.send("still");
  std::array<char, 100> bytes{};
  EXPECT_EQ(a.receive(asio::buffer(bytes)), 5U);
}

}  // namespace
}  // namespace lilo
