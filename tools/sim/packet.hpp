// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilo::sim {

inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;

/// A UDP payload on its way to the capture.
struct Packet {
  std::int64_t sent_ns = 0;  ///< after the recording's start, true time
  std::uint16_t port = kDataPort;
  std::vector<std::uint8_t> payload;
};

inline void put_u16(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  bytes[at] = static_cast<std::uint8_t>(value & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>((value >> 8U) & 0xFFU);
}

inline void put_u32(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  put_u16(bytes, at, value & 0xFFFFU);
  put_u16(bytes, at + 2, value >> 16U);
}

}  // namespace lilo::sim
