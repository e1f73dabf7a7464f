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

/// A vector that grows by resize() does not write zeros first where returns are written next: those
/// of an HDL-64E are 3 MB a turn. Who wants the memory touched gives resize() or assign() a value.
template <typename T>
struct LeavesUnwritten : std::allocator<T> {
  template <typename U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
};
using Returns = std::vector<Return, LeavesUnwritten<Return>>;

/// Where the stamps of a scan come from.
enum class ClockSource : std::uint8_t {
  host,    ///< the time the computer received (or captured) the packets places the sensor's hour
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
  float hole_start_rad = 0.0F;  ///< azimuth (as Return::azimuth_rad) where the largest hole starts,
  float hole_width_rad = 0.0F;  ///< and how far it reaches in the direction of turning; 0 = none. A
                                ///< sector the sensor never fires in is none once it is known
  PacketCounts packets;
  BeamTable beams;
  /// Firing order; of two echoes of a VLP-16's firing the last comes first, of an HDL-64E's the
  /// strongest (measured, drivers/README.md). Capacity is reserved once and kept.
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
