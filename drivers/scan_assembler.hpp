// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/blind_sector.hpp"
#include "drivers/coverage.hpp"
#include "drivers/packet_decoder.hpp"
#include "drivers/scan_builder.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/sensor_status.hpp"

#include <cstdint>

namespace lilo {

/// Columns to scans. A scan starts with the first column at or beyond the cut azimuth and ends
/// with the last one before it, wherever in a packet that is. Returns go straight into the sink's
/// scan. Data before the first cut, and after a restart or a gap of more than half a second up to
/// the next one, are left out.
class ScanAssembler {
 public:
  ScanAssembler(const SensorConfig& config, Scan& target, ScanSink& sink);

  void describe(SensorStatus& status) const;

  /// What a new packet tells of those before it.
  struct Loss {
    std::uint32_t lost = 0;        ///< of those that are missing; the others are of a blind sector
    std::uint64_t never_sent = 0;  ///< counted as lost before the blind sector was known
  };
  /// A packet that is newer than all before. `line_ns` is its stamp on the sensor's line, `missing`
  /// how many packets were due between the one before and this one.
  Loss add(const PacketDecoder& decoder, std::int64_t line_ns, std::uint32_t missing,
           SensorClock& clock);
  /// A packet that was overtaken: what belongs to the scan being written is put in its place.
  /// False when it had been counted as lost in a scan that was handed on before.
  bool add_late(const PacketDecoder& decoder, std::int64_t line_ns);
  void note_duplicate() { ++counts_.duplicated; }

  /// Hands on what there is as a partial scan and waits for the next cut.
  void interrupt(const SensorClock& clock);
  /// At the end of the data: the scan begun will never be whole. True when there was one.
  [[nodiscard]] bool in_scan() const { return in_scan_; }

  [[nodiscard]] std::uint64_t scans_complete() const { return scans_complete_; }
  [[nodiscard]] std::uint64_t scans_partial() const { return scans_partial_; }
  [[nodiscard]] std::uint64_t stalls() const { return stalls_; }

 private:
  void add_column(const PacketDecoder& decoder, std::size_t column, std::int64_t line_ns,
                  SensorClock& clock);
  [[nodiscard]] std::uint32_t without_blind(const PacketDecoder& decoder, std::int64_t line_ns,
                                            std::uint32_t missing);
  void spread_loss(std::uint32_t lost, double period_ns, std::int64_t line_ns);
  void follow_direction(double ticks_per_ns, const SensorClock& clock);
  [[nodiscard]] Coverage::Hole largest_hole() const;
  [[nodiscard]] double phase_of(double azimuth_ticks) const;
  [[nodiscard]] double sweep_to(double phase, std::int64_t column_ns, double ticks_per_ns) const;
  void begin_scan(const PacketDecoder& decoder, std::int64_t column_ns, SensorClock& clock);
  void end_scan(const SensorClock& clock, bool whole);

  double cut_ticks_;
  double max_hole_ticks_;
  Scan* scan_;
  ScanSink& sink_;

  int direction_ = 1;        // +1: azimuth grows (clockwise)
  int against_ = 0;          // packets in a row that turned the other way
  bool has_column_ = false;  // what is below holds of the column before
  double phase_ = 0.0;
  std::int64_t column_ns_ = 0;
  std::int64_t last_firing_ns_ = 0;

  bool in_scan_ = false;
  bool follows_scan_ = false;       // the scan being written begins where one ended
  std::int64_t scan_start_ns_ = 0;  // on the sensor's line
  std::int64_t scan_end_ns_ = 0;
  BlindSector blind_;  // in phases
  Coverage coverage_;
  PacketCounts counts_;
  std::uint32_t lost_after_cut_ = 0;  // of a gap that reaches beyond the next cut
  std::uint64_t cuts_passed_ = 0;

  std::uint64_t scans_complete_ = 0, scans_partial_ = 0, stalls_ = 0;
};

}  // namespace lilo
