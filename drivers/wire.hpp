// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>

/// What every Velodyne data packet shares (VLP-16 manual 9.3, HDL-64E S3 manual app. E): 12 blocks
/// of 100 bytes (u16 flag, u16 azimuth, 32 x {u16 distance, u8 intensity}), a u32 stamp in
/// microseconds past the hour, and two bytes whose meaning depends on the model. Little endian.
namespace lilo::wire {

inline constexpr std::size_t kDataPacketBytes = 1206;
inline constexpr std::size_t kPositionPacketBytes = 512;
inline constexpr int kBlocks = 12;
inline constexpr std::size_t kBlockBytes = 100;
inline constexpr std::size_t kBlockHeaderBytes = 4;
inline constexpr int kChannelsPerBlock = 32;
inline constexpr std::size_t kChannelBytes = 3;
inline constexpr std::size_t kStampOffset = 1200;
inline constexpr std::size_t kTailOffset = 1204;

inline constexpr std::uint16_t kUpperFlag = 0xEEFF;   ///< lasers 0-31 of every model
inline constexpr std::uint16_t kLowerFlag = 0xDDFF;   ///< lasers 32-63 of HDL-64E and VLS-128
inline constexpr std::uint16_t kThirdFlag = 0xCCFF;   ///< VLS-128 lasers 64-95
inline constexpr std::uint16_t kFourthFlag = 0xBBFF;  ///< VLS-128 lasers 96-127

inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;

/// Azimuth on the wire: hundredths of a degree, clockwise seen from above.
inline constexpr int kTicksPerTurn = 36000;
inline constexpr double kRadPerTick = 2.0 * std::numbers::pi / kTicksPerTurn;

/// A VLP-16 may count past the hour before it wraps (ros-drivers/velodyne issue 218).
inline constexpr std::uint32_t kMaxStampUs = 3'600'999'999U;

inline std::uint8_t u8(const std::byte* p) { return std::to_integer<std::uint8_t>(*p); }
inline std::uint16_t u16(const std::byte* p) {
  return static_cast<std::uint16_t>(u8(p) | (u8(p + 1) << 8));
}
inline std::uint32_t u32(const std::byte* p) {
  return static_cast<std::uint32_t>(u16(p)) | (static_cast<std::uint32_t>(u16(p + 2)) << 16);
}

inline const std::byte* block(const std::byte* packet, int b) {
  return packet + static_cast<std::size_t>(b) * kBlockBytes;
}
inline std::uint16_t block_flag(const std::byte* packet, int b) { return u16(block(packet, b)); }
inline int block_azimuth(const std::byte* packet, int b) { return u16(block(packet, b) + 2); }

}  // namespace lilo::wire
