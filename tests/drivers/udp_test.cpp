// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_source.hpp"
#include "tests/drivers/packets.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <gtest/gtest.h>

#include <chrono>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace lilo {
namespace {

using boost::asio::ip::udp;
using std::chrono::milliseconds;

UdpConfig loopback() { return {.bind_address = "127.0.0.1", .data_port = 0, .position_port = 0}; }

class Sender {
 public:
  explicit Sender(std::uint16_t port, const char* from = "127.0.0.1")
      : socket_(context_, udp::endpoint(boost::asio::ip::make_address(from), 0)),
        to_(boost::asio::ip::make_address("127.0.0.1"), port) {}
  void send(const std::vector<std::byte>& bytes) {
    socket_.send_to(boost::asio::buffer(bytes.data(), bytes.size()), to_);
  }

 private:
  boost::asio::io_context context_;
  udp::socket socket_;
  udp::endpoint to_;
};

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

TEST(UdpSource, GivesWhatWasSentInOrderWithItsTime) {
  auto source = open_udp(loopback());
  Sender sender(source->data_port());
  const auto packets = test::vlp16_packets(200, {});
  PacketView packet;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    sender.send(packets[i].bytes);
    if (i % 50 != 49) continue;  // in batches, which recvmmsg takes at once
    for (std::size_t k = i - 49; k <= i; ++k) {
      ASSERT_EQ(source->read(packet, milliseconds(2000)), ReadResult::packet);
      ASSERT_TRUE(std::equal(packet.payload.begin(), packet.payload.end(), packets[k].bytes.begin(),
                             packets[k].bytes.end()));
      EXPECT_EQ(packet.source_ipv4, 0x7F000001U);
      EXPECT_EQ(packet.destination_port, source->data_port());
      EXPECT_NEAR(static_cast<double>(packet.received_ns - now_ns()), 0.0, 5e9);
    }
  }
  EXPECT_EQ(source->read(packet, milliseconds(1)), ReadResult::timeout);
  EXPECT_EQ(source->counts().packets, 200U);
}

TEST(UdpSource, OtherSendersAndOversizedPacketsAreCounted) {
  UdpConfig config = loopback();
  config.sensor_address = "127.0.0.2";
  auto source = open_udp(config);
  Sender sensor(source->data_port(), "127.0.0.2"), other(source->data_port(), "127.0.0.3");
  other.send(std::vector<std::byte>(1206));
  sensor.send(std::vector<std::byte>(4000));
  sensor.send(std::vector<std::byte>(7));
  PacketView packet;
  ASSERT_EQ(source->read(packet, milliseconds(2000)), ReadResult::packet);
  EXPECT_EQ(packet.payload.size(), 7U);
  EXPECT_EQ(source->counts().foreign, 1U);
  EXPECT_EQ(source->counts().truncated, 1U);
}

TEST(UdpSource, TheKernelsDropsAreCounted) {
  UdpConfig config = loopback();
  config.receive_buffer_bytes = 16 * 1024;
  auto source = open_udp(config);
  Sender sender(source->data_port());
  constexpr std::uint64_t kSent = 500;
  for (std::uint64_t i = 0; i < kSent; ++i) sender.send(std::vector<std::byte>(1206));
  PacketView packet;
  while (source->read(packet, milliseconds(1)) == ReadResult::packet) {
  }
  sender.send(std::vector<std::byte>(1206));  // the count comes with the next one
  ASSERT_EQ(source->read(packet, milliseconds(2000)), ReadResult::packet);
  EXPECT_GT(source->counts().kernel_dropped, 0U);
  EXPECT_EQ(source->counts().packets + source->counts().kernel_dropped, kSent + 1);
}

TEST(UdpSource, SaysWhatBufferItGot) {
  UdpConfig config = loopback();
  config.receive_buffer_bytes = 100'000;
  const int granted = open_udp(config)->receive_buffer_bytes();
  EXPECT_GE(granted, 100'000);  // the kernel doubles what is asked, up to its limit
}

TEST(UdpSource, AddressesThatCannotBeHadAreOneClearLine) {
  const auto refusal = [](const UdpConfig& config) -> std::string {
    try {
      open_udp(config);
    } catch (const DriverError& e) {
      return e.what();
    }
    return "opened";
  };
  UdpConfig config = loopback();
  config.bind_address = "300.1.1.1";
  EXPECT_EQ(refusal(config), "bind address: expected an IPv4 address, found \"300.1.1.1\"");
  config = loopback();
  config.sensor_address = "velodyne";
  EXPECT_EQ(refusal(config), "sensor address: expected an IPv4 address, found \"velodyne\"");
  config = loopback();
  const auto first = open_udp(config);
  config.data_port = first->data_port();
  EXPECT_NE(refusal(config).find("cannot listen there"), std::string::npos);
}

TEST(UdpSource, JoinsAMulticastGroup) {
  UdpConfig config = loopback();
  config.multicast_group = "10.1.2.3";
  EXPECT_THROW(open_udp(config), DriverError);
}

/// The descriptor of this process that has the port; -1: none.
int descriptor_of(std::uint16_t port) {
  for (int fd = 0; fd < 1024; ++fd) {
    sockaddr_in address{};
    socklen_t size = sizeof(address);
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
        address.sin_family == AF_INET && ntohs(address.sin_port) == port) {
      return fd;
    }
  }
  return -1;
}

// Always readable, and no read succeeds: in place of the socket there is a file.
TEST(UdpSource, CountsErrorsOfItsSocketAndDoesNotSpin) {
  auto source = open_udp(loopback());
  const int fd = descriptor_of(source->data_port());
  ASSERT_GE(fd, 0);
  const int file = open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(dup2(file, fd), fd);
  close(file);
  PacketView packet;
  int reads = 0;
  const auto end = std::chrono::steady_clock::now() + milliseconds(200);
  for (; std::chrono::steady_clock::now() < end; ++reads) {
    EXPECT_EQ(source->read(packet, milliseconds(100)), ReadResult::timeout);
  }
  EXPECT_GT(source->counts().receive_errors, 0U);
  EXPECT_LE(reads, 20);  // 10 ms after every error
}

}  // namespace
}  // namespace lilo
