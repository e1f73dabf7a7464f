// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/packets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace lilo::test {

PacketView TimedPacket::view() const {
  return {.received_ns = received_ns,
          .source_ipv4 = source_ipv4,
          .source_port = 2368,
          .destination_port = port,
          .payload = bytes};
}

void PacketBytes::u16(std::size_t at, int value) {
  bytes_[at] = static_cast<std::byte>(value & 0xFF);
  bytes_[at + 1] = static_cast<std::byte>((value >> 8) & 0xFF);
}
void PacketBytes::block(int b, std::uint16_t flag, int azimuth_ticks) {
  u16(static_cast<std::size_t>(b) * 100, flag);
  u16(static_cast<std::size_t>(b) * 100 + 2, azimuth_ticks);
}
void PacketBytes::channel(int b, int c, int steps, int intensity) {
  const std::size_t at = static_cast<std::size_t>(b) * 100 + 4 + static_cast<std::size_t>(c) * 3;
  u16(at, steps);
  bytes_[at + 2] = static_cast<std::byte>(intensity);
}
void PacketBytes::stamp(std::uint32_t us) {
  u16(1200, static_cast<int>(us & 0xFFFFU));
  u16(1202, static_cast<int>(us >> 16U));
}
void PacketBytes::tail(std::uint8_t type, std::uint8_t value) {
  bytes_[1204] = std::byte{type};
  bytes_[1205] = std::byte{value};
}

double Room::distance_to_surface_m(const Return& p) {
  const auto x = static_cast<double>(p.x_m), y = static_cast<double>(p.y_m);
  const auto z = static_cast<double>(p.z_m);
  return std::min({std::abs(std::abs(x) - 6.0), std::abs(std::abs(y) - 5.0), std::abs(z + 1.5),
                   std::abs(z - 2.5)});
}
double Room::distance_to_glass_m(const Return& p) {
  return std::abs(static_cast<double>(p.x_m) - 3.0);
}
bool Room::beyond(double x, double y, double z) {
  return std::abs(x) > 6.0 || std::abs(y) > 5.0 || z < -1.5 || z > 2.5;
}

TimedPacket position_packet(std::uint32_t stamp_us, int pps, const std::string& sentence,
                            std::int64_t received_ns) {
  TimedPacket packet;
  packet.received_ns = received_ns;
  packet.port = 8308;
  packet.bytes.resize(512);
  for (std::size_t i = 0; i < 4; ++i)
    packet.bytes[0xC6 + i] = static_cast<std::byte>((stamp_us >> (8 * i)) & 0xFFU);
  packet.bytes[0xCA] = static_cast<std::byte>(pps);
  for (std::size_t i = 0; i < sentence.size() && 0xCE + i < 512; ++i)
    packet.bytes[0xCE + i] = static_cast<std::byte>(sentence[i]);
  return packet;
}

std::string gprmc(int hour, int minute, int second, int day, int month, int year, char status) {
  char body[128];
  std::snprintf(body, sizeof(body),
                "GPRMC,%02d%02d%02d,%c,4807.038,N,01131.000,E,000.0,000.0,%02d%02d%02d,003.1,W",
                hour, minute, second, status, day, month, year % 100);
  int sum = 0;
  for (const char* c = body; *c != '\0'; ++c) sum ^= *c;
  char sentence[160];
  std::snprintf(sentence, sizeof(sentence), "$%s*%02X\r\n", body, sum);
  return sentence;
}

namespace {

class Keep final : public ScanSink {
 public:
  explicit Keep(std::vector<Scan>& scans) : scans_(scans) {}
  Scan& exchange(Scan& finished) override {
    scans_.push_back(finished);
    finished.clear();
    return finished;
  }

 private:
  std::vector<Scan>& scans_;
};

}  // namespace

Outcome build(const std::vector<TimedPacket>& packets, const SensorConfig& config) {
  Outcome outcome;
  Keep keep(outcome.scans);
  Scan scan;
  ScanBuilder builder(config, scan, keep);
  for (const TimedPacket& packet : packets) builder.feed(packet.view());
  outcome.counts = builder.counts();
  outcome.status = builder.status();
  return outcome;
}

}  // namespace lilo::test
