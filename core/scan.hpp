// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

/// One revolution of the sensor as the drivers hand it to the odometry.
/// Plain values: no thread rules beyond "one owner at a time".
namespace lilo {

/// Which echo of a firing a return is. Single-return sensors send `strongest` or `last`.
enum class ReturnKind : std::uint8_t {
  strongest,  ///< the brightest echo, and it is not the last one (or the mode is not dual)
  last,       ///< the farthest echo, and it is not the strongest one (or the mode is `last`)
  both,       ///< dual mode, and one echo was both: stored once
};

/// One laser return. 24 bytes; a scan holds them in firing order.
struct Return {
  float x_m, y_m, z_m;     ///< sensor frame at the instant of this firing, REP-103 axes
  float azimuth_rad;       ///< direction of the beam, counter-clockwise from +x, in [-pi, pi)
  std::int32_t t_ns;       ///< firing time after Scan::start_ns
  std::uint8_t ring;       ///< beam, counted by elevation, 0 = lowest
  std::uint8_t intensity;  ///< as sent by the sensor; HDL-64E: with its focal correction
  ReturnKind kind;
  std::uint8_t reserved;
};
static_assert(sizeof(Return) == 24);

/// With this allocator resize() leaves new elements uninitialised, because returns are written
/// there next: 3 MB in a revolution of an HDL-64E. resize() and assign() with a value still write
/// it.
template <typename T>
struct DefaultInitAllocator : std::allocator<T> {
  template <typename U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
};
using Returns = std::vector<Return, DefaultInitAllocator<Return>>;

/// Where the stamps of a scan come from.
enum class ClockSource : std::uint8_t {
  host,    ///< the sensor's clock, in the hour in which the computer received (or captured) it
  gps,     ///< GPRMC sentence and PPS lock: the sensor's clock is UTC
  replay,  ///< times given by a data set
};

/// What became of the packets between the start and the end of a scan.
struct PacketCounts {
  std::uint32_t expected = 0;    ///< by the sensor's own stamps
  std::uint32_t received = 0;    ///< used in this scan
  std::uint32_t lost = 0;        ///< expected and not seen until the scan was handed on
  std::uint32_t duplicated = 0;  ///< seen again and ignored
  std::uint32_t reordered = 0;   ///< came after a later one
};

inline constexpr int kMaxRings = 128;

/// Elevation of every beam, by ring. Rings are sorted: elevation grows with the index.
struct BeamTable {
  int ring_count = 0;
  std::array<float, kMaxRings> elevation_rad{};
};

struct Scan {
  std::uint64_t index = 0;    ///< revolutions since the source was opened; a gap is a dropped scan
  std::int64_t start_ns = 0;  ///< UTC of the first firing
  std::int64_t end_ns = 0;    ///< UTC of the last firing: the instant the pose is for
  ClockSource clock = ClockSource::host;
  bool complete = false;            ///< a whole revolution with no hole beyond the configured one
  bool motion_compensated = false;  ///< the data set's authors already moved all returns to end_ns
  float coverage_rad = 0.0F;        ///< azimuth swept by packets that arrived, at most 2 pi
  /// Azimuth (as Return::azimuth_rad) where the largest hole starts, and its width in the direction
  /// of rotation; 0: no hole. A sector in which the sensor never fires is not a hole, once known.
  float hole_start_rad = 0.0F, hole_width_rad = 0.0F;
  PacketCounts packets;
  BeamTable beams;
  /// In firing order. Of two echoes of one firing a VLP-16 sends the last one first, an HDL-64E the
  /// strongest one (measured, drivers/README.md). Capacity is reserved once and kept.
  Returns returns;

  /// Empties the scan for reuse; keeps the memory.
  void clear() {
    auto kept = std::move(returns);
    kept.clear();
    *this = Scan{};
    returns = std::move(kept);
  }
};

}  // namespace lilo
