// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/bag.hpp"

#include <fstream>
#include <iterator>

namespace lilo::test {
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kPacket = 1206;

struct Bytes {
  std::string data;
  [[nodiscard]] unsigned u8(std::size_t at) const {
    return static_cast<unsigned char>(data.at(at));
  }
  [[nodiscard]] unsigned be16(std::size_t at) const { return u8(at) << 8U | u8(at + 1); }
  [[nodiscard]] unsigned be32(std::size_t at) const { return be16(at) << 16U | be16(at + 2); }
  // SQLite's variable-length integer; moves `at` behind it.
  std::size_t varint(std::size_t& at) const {
    std::size_t value = 0;
    while (true) {
      const unsigned byte = u8(at++);
      value = value << 7U | (byte & 0x7FU);
      if ((byte & 0x80U) == 0) return value;
    }
  }
};

// The whole record of one cell of a table leaf page.
std::string record(const Bytes& file, std::size_t cell) {
  const std::size_t size = file.varint(cell);
  file.varint(cell);  // row id
  constexpr std::size_t kMaxLocal = kPage - 35, kMinLocal = (kPage - 12) * 32 / 255 - 23;
  if (size <= kMaxLocal) return file.data.substr(cell, size);
  const std::size_t surplus = kMinLocal + (size - kMinLocal) % (kPage - 4);
  const std::size_t local = surplus <= kMaxLocal ? surplus : kMinLocal;
  std::string whole = file.data.substr(cell, local);
  for (unsigned page = file.be32(cell + local); page != 0 && whole.size() < size;) {
    const std::size_t at = (page - 1) * kPage;
    whole += file.data.substr(at + 4, kPage - 4);
    page = file.be32(at);
  }
  whole.resize(size);
  return whole;
}

bool is_packet(const std::string& data, std::size_t at) {
  const std::string banks = "\xEE\xDD\xCC\xBB";
  for (std::size_t b = 0; b < 12; ++b) {
    const std::size_t flag = at + 100 * b;
    if (flag + 1 >= data.size() || data[flag] != '\xFF') return false;
    if (banks.find(data[flag + 1]) == std::string::npos) return false;
  }
  return true;
}

}  // namespace

std::vector<TimedPacket> packets_of_bag(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const Bytes file{std::string(std::istreambuf_iterator<char>(in), {})};
  std::vector<TimedPacket> packets;
  for (std::size_t page = kPage; page + kPage <= file.data.size(); page += kPage) {
    constexpr unsigned kTableLeaf = 0x0D;
    if (file.u8(page) != kTableLeaf) continue;
    for (unsigned i = 0; i < file.be16(page + 3); ++i) {
      const std::string data = record(file, page + file.be16(page + 8 + std::size_t{2} * i));
      for (std::size_t at = 0; at + kPacket <= data.size();) {
        if (!is_packet(data, at)) {
          ++at;
          continue;
        }
        const auto* bytes = reinterpret_cast<const std::byte*>(data.data()) + at;
        packets.push_back(
            {.bytes = {bytes, bytes + kPacket}, .received_ns = 1'673'400'472'000'000'000});
        at += kPacket;
      }
    }
  }
  return packets;
}

}  // namespace lilo::test
