// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/capture_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace lilo::test {
namespace {

void be16(Buffer& out, std::size_t value) {
  out.push_back(static_cast<std::byte>((value >> 8U) & 0xFFU));
  out.push_back(static_cast<std::byte>(value & 0xFFU));
}
void append(Buffer& out, const Buffer& more) { out.insert(out.end(), more.begin(), more.end()); }

// Integers in the byte order of the file.
class File {
 public:
  explicit File(bool big_endian) : big_endian_(big_endian) {}
  void integer(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      const int shift = 8 * (big_endian_ ? bytes - 1 - i : i);
      text_.push_back(static_cast<char>((value >> shift) & 0xFFU));
    }
  }
  void bytes(const Buffer& data, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) text_.push_back(static_cast<char>(data[i]));
  }
  [[nodiscard]] std::string take() { return text_; }

 private:
  bool big_endian_;
  std::string text_;
};

}  // namespace

Buffer udp_datagram(const Buffer& payload, std::uint16_t port) {
  Buffer out;
  out.reserve(payload.size() + 8);
  be16(out, 2368);
  be16(out, port);
  be16(out, payload.size() + 8);
  be16(out, 0);
  append(out, payload);
  return out;
}

Buffer ipv4(const Buffer& datagram, int option_bytes, std::uint16_t fragment, int protocol) {
  Buffer out;
  out.reserve(datagram.size() + 60);
  const auto options = static_cast<std::size_t>(option_bytes);
  out.push_back(static_cast<std::byte>(0x40U + (20 + options) / 4));
  out.push_back(std::byte{0});
  be16(out, 20 + options + datagram.size());
  be16(out, 1);
  be16(out, fragment);
  out.push_back(std::byte{64});
  out.push_back(static_cast<std::byte>(protocol));
  be16(out, 0);
  for (const int b : {192, 168, 1, 201, 255, 255, 255, 255})
    out.push_back(static_cast<std::byte>(b));
  out.insert(out.end(), options, std::byte{1});  // "no operation"
  append(out, datagram);
  return out;
}

Buffer ethernet(const Buffer& ip, const std::vector<std::uint16_t>& vlan_tags, std::uint16_t type) {
  Buffer out(12, std::byte{0xFF});
  for (const std::uint16_t tag : vlan_tags) {
    be16(out, tag);
    be16(out, 42);  // the VLAN's number
  }
  be16(out, type);
  append(out, ip);
  return out;
}

Buffer cooked(const Buffer& ip) {
  Buffer out(14, std::byte{0});
  be16(out, 0x0800);
  append(out, ip);
  return out;
}

Buffer cooked2(const Buffer& ip) {
  Buffer out;
  out.reserve(ip.size() + 20);
  be16(out, 0x0800);
  out.insert(out.end(), 18, std::byte{0});
  append(out, ip);
  return out;
}

std::string pcap_bytes(const std::vector<Record>& records, const CaptureFormat& format) {
  File file(format.big_endian);
  file.integer(format.nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4, 4);
  file.integer(2, 2);
  file.integer(4, 2);
  file.integer(0, 8);
  file.integer(65535, 4);
  file.integer(static_cast<std::uint64_t>(format.link_type), 4);
  for (const Record& r : records) {
    const std::size_t captured = std::min(r.captured, r.frame.size());
    file.integer(static_cast<std::uint64_t>(r.time_ns / 1'000'000'000), 4);
    const std::int64_t rest_ns = r.time_ns % 1'000'000'000;
    file.integer(static_cast<std::uint64_t>(format.nanoseconds ? rest_ns : rest_ns / 1000), 4);
    file.integer(captured, 4);
    file.integer(r.frame.size(), 4);
    file.bytes(r.frame, captured);
  }
  return file.take();
}

std::string pcapng_bytes(const std::vector<Record>& records) {
  File file(false);
  file.integer(0x0A0D0D0A, 4);  // section header
  file.integer(28, 4);
  file.integer(0x1A2B3C4D, 4);
  file.integer(1, 4);
  file.integer(~0ULL, 8);
  file.integer(28, 4);
  file.integer(1, 4);  // interface: Ethernet, microseconds
  file.integer(20, 4);
  file.integer(1, 4);
  file.integer(0, 4);
  file.integer(20, 4);
  for (const Record& r : records) {
    const std::size_t padding = (4 - r.frame.size() % 4) % 4;
    const std::size_t length = 32 + r.frame.size() + padding;
    const auto us = static_cast<std::uint64_t>(r.time_ns / 1000);
    file.integer(6, 4);  // enhanced packet
    file.integer(length, 4);
    file.integer(0, 4);
    file.integer(us >> 32U, 4);
    file.integer(us & 0xFFFFFFFFU, 4);
    file.integer(r.frame.size(), 4);
    file.integer(r.frame.size(), 4);
    file.bytes(r.frame, r.frame.size());
    file.integer(0, static_cast<int>(padding));
    file.integer(length, 4);
  }
  return file.take();
}

std::vector<Record> records_of(const std::vector<TimedPacket>& packets) {
  std::vector<Record> records;
  records.reserve(packets.size());
  for (const TimedPacket& p : packets) {
    records.push_back({ethernet(ipv4(udp_datagram(p.bytes, p.port))), p.received_ns});
  }
  return records;
}

std::string write_file(const std::string& name, const std::string& bytes) {
  // Tests run side by side, and several write files of one name.
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(testing::TempDir()) / "lilo_drivers_test" /
                      test.test_suite_name() / test.name();
  std::filesystem::create_directories(folder);
  std::string path = folder / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

}  // namespace lilo::test
