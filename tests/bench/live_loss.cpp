// SPDX-License-Identifier: BSD-3-Clause
// A sender process plays an HDL-64E at S2 rate (3472 packets/s) over loopback to a receiver that
// decodes and assembles; prints what was lost, and by whom. live_loss [SECONDS]; exit code 1 when a
// packet is missing that the kernel did not count as dropped.
#include "tests/drivers/packets.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using namespace lilo;  // NOLINT(google-build-using-namespace)
using std::chrono::steady_clock;

constexpr double kPacketsPerSecond = 1e6 / 288.0;

class Slots final : public ScanSink {
 public:
  Scan& exchange(Scan& finished) override {
    Scan& other = &finished == &scans_[0] ? scans_[1] : scans_[0];
    other.clear();
    return other;
  }
  Scan scans_[2];
};

// Packets of one turn again and again, each with its own stamp.
void send(std::uint16_t port, std::uint64_t count) {
  auto packets = test::hdl64e_packets(347, {.calibration = test::sample_calibration(true)});
  boost::asio::io_context context;
  boost::asio::ip::udp::socket socket(context, boost::asio::ip::udp::v4());
  const boost::asio::ip::udp::endpoint to(boost::asio::ip::address_v4::loopback(), port);
  const auto start = steady_clock::now();
  for (std::uint64_t i = 0; i < count; ++i) {
    std::this_thread::sleep_until(start + std::chrono::microseconds(288 * i));
    auto& bytes = packets[i % packets.size()].bytes;
    const auto us = static_cast<std::uint32_t>((1'000'000'000 + 288 * i) % 3'600'000'000);
    for (std::size_t k = 0; k < 4; ++k)
      bytes[1200 + k] = static_cast<std::byte>(us >> (8 * k) & 0xFFU);
    socket.send_to(boost::asio::buffer(bytes.data(), bytes.size()), to);
  }
}

int receive(UdpSource& source, std::uint64_t count) {
  SensorConfig config;
  config.calibration_file = (std::filesystem::temp_directory_path() / "lilo_live.yaml").string();
  store_calibration(config.calibration_file, test::sample_calibration(true));
  Slots slots;
  ScanBuilder builder(config, slots.scans_[0], slots);
  PacketView packet;
  int silent = 0;
  while (silent < 20) {
    if (source.read(packet, std::chrono::milliseconds(100)) == ReadResult::packet) {
      builder.feed(packet);
      silent = 0;
    } else if (source.counts().packets > 0) {
      ++silent;
    }
  }
  const DriverCounts& c = builder.counts();
  const std::uint64_t missing = count - source.counts().packets;
  std::printf("sent %lu  received %lu  lost by stamps %lu  dropped by the kernel %lu  scans %lu\n",
              count, source.counts().packets, c.packets_lost, source.counts().kernel_dropped,
              c.scans_complete);
  return missing == source.counts().kernel_dropped ? 0 : 1;
}

}  // namespace

int main(int argument_count, char** arguments) try {
  const double seconds = argument_count > 1 ? std::stod(arguments[1]) : 10.0;
  const auto count = static_cast<std::uint64_t>(seconds * kPacketsPerSecond);
  const auto source = open_udp({.bind_address = "127.0.0.1", .data_port = 0, .position_port = 0});
  std::printf("receive buffer %d bytes\n", source->receive_buffer_bytes());
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    send(source->data_port(), count);
    _exit(0);
  }
  const int result = receive(*source, count);
  waitpid(child, nullptr, 0);
  return result;
} catch (const std::exception& e) {
  std::fprintf(stderr, "live_loss: %s\n", e.what());
  return 1;
}
