// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/scan_assembler.hpp"

#include "drivers/azimuth.hpp"

#include <algorithm>
#include <cmath>

namespace lilo {
namespace {

constexpr double kTurn = wire::kTicksPerTurn;
constexpr double kBackwardTicks = 1000.0;  // encoder noise and late columns, not a whole turn less
// The last firings of an HDL-64E's packet are 2.3 us before the next one's first: a stamp that
// wavers by more must not put them out of order.
constexpr std::int64_t kStampJitterNs = 20'000;
constexpr int kAgainstPackets = 20;  // before a change of direction is believed
// The slowest head turns at 5 Hz. One that has not come round after this is standing still.
constexpr std::int64_t kMaxScanNs = 500'000'000;
constexpr double kSlowestTurnNs = 200e6;

// The most returns a turn of this speed can have. A packet's own speed is up to 3 percent wrong:
// HDL-64E, dual returns, a tick of noise in two steps.
std::size_t max_scan_returns(const PacketDecoder& decoder) {
  const double column_ns =
      decoder.packet_period_ns() / static_cast<double>(decoder.columns().size());
  const double turn_ns = std::min(kTurn / std::abs(decoder.ticks_per_ns()), kSlowestTurnNs);
  return static_cast<std::size_t>(turn_ns / column_ns + 1.0) * decoder.max_column_returns();
}

}  // namespace

ScanAssembler::ScanAssembler(const SensorConfig& config, Scan& target, ScanSink& sink)
    : cut_ticks_(wrap_ticks(config.cut_azimuth_rad / wire::kRadPerTick)),
      max_hole_ticks_(config.max_hole_rad / wire::kRadPerTick),
      scan_(&target),
      sink_(sink) {}

// How many of the `missing` packets before this one are lost, and not of a blind sector.
std::uint32_t ScanAssembler::without_blind(const PacketDecoder& decoder, std::int64_t line_ns,
                                           std::uint32_t missing) {
  if (missing == 0 || !has_column_) return missing;
  const Column& c = decoder.columns().front();
  const double sweep =
      sweep_to(phase_of(c.azimuth_ticks), line_ns + c.first_ns, decoder.ticks_per_ns());
  const double packet_ticks = std::abs(decoder.ticks_per_ns()) * decoder.packet_period_ns();
  return blind_.see_gap({phase_, sweep}, packet_ticks, missing);
}

void ScanAssembler::describe(SensorStatus& status) const {
  const auto sector = blind_.sector();
  if (!sector) return;
  status.blind_start_rad =
      static_cast<double>(ccw_rad_from_ticks(cut_ticks_ + direction_ * sector->start_ticks));
  status.blind_width_rad = sector->width_ticks * wire::kRadPerTick;
}

ScanAssembler::Loss ScanAssembler::add(const PacketDecoder& decoder, std::int64_t line_ns,
                                       std::uint32_t missing, SensorClock& clock) {
  const std::uint32_t lost = without_blind(decoder, line_ns, missing);
  const std::uint64_t never_sent = blind_.take_miscounted();
  follow_direction(decoder.ticks_per_ns(), clock);
  if (lost > 0) spread_loss(lost, decoder.packet_period_ns(), line_ns);
  for (std::size_t i = 0; i < decoder.columns().size(); ++i) add_column(decoder, i, line_ns, clock);
  if (in_scan_) ++counts_.received;
  return {lost, never_sent};
}

bool ScanAssembler::add_late(const PacketDecoder& decoder, std::int64_t line_ns) {
  if (!in_scan_) return true;  // lost outside of scans until now
  bool used = false;
  const auto columns = decoder.columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::int64_t column_ns = line_ns + columns[i].first_ns;
    if (column_ns < scan_start_ns_) continue;
    // Wrong azimuths look like a blind sector within the packet, and put what is behind it later.
    if (line_ns + columns[i].last_ns > last_firing_ns_) continue;
    auto& returns = scan_->returns;
    const auto t_ns = static_cast<std::int32_t>(column_ns - scan_start_ns_);
    const auto place = std::upper_bound(returns.begin(), returns.end(), t_ns,
                                        [](std::int32_t t, const Return& r) { return t < r.t_ns; });
    // Wrong stamps only: a firing among those of another column would break the order.
    const std::int32_t last_t_ns = t_ns + columns[i].last_ns - columns[i].first_ns;
    if (place != returns.end() && place->t_ns < last_t_ns) continue;
    used = true;
    const auto place_index = place - returns.begin();
    const auto old_size = static_cast<std::ptrdiff_t>(returns.size());
    decoder.append(i, t_ns, returns);
    std::rotate(returns.begin() + place_index, returns.begin() + old_size, returns.end());
    sink_.inserted(static_cast<std::size_t>(place_index));
    coverage_.mark(phase_of(columns[i].azimuth_ticks));
  }
  if (!used) return line_ns < scan_start_ns_ && !follows_scan_;
  ++counts_.reordered;
  ++counts_.received;
  if (counts_.lost == 0) return !follows_scan_;
  --counts_.lost;
  return true;
}

double ScanAssembler::phase_of(double azimuth_ticks) const {
  return wrap_ticks(direction_ * (azimuth_ticks - cut_ticks_));
}

// Lost packets before the cut belong to the scan that ends there, the others to the next one.
void ScanAssembler::spread_loss(std::uint32_t lost, double period_ns, std::int64_t line_ns) {
  if (!has_column_) return;
  const double gap_ns = lost * period_ns;
  const double gap_start_ns = static_cast<double>(line_ns - column_ns_) - gap_ns;
  // Only the turning speed can tell where in the gap the cut lies; the last scan's will do.
  const double turn_ns = static_cast<double>(scan_end_ns_ - scan_start_ns_);
  const double swept = std::max(phase_, 1.0);
  const double to_cut_ns =
      in_scan_ && swept > 0.05 * kTurn ? turn_ns * (kTurn - phase_) / swept : gap_start_ns + gap_ns;
  const double before = std::clamp((to_cut_ns - gap_start_ns) / period_ns, 0.0, double{1} * lost);
  const auto before_cut = static_cast<std::uint32_t>(std::llround(before));
  counts_.lost += before_cut;
  lost_after_cut_ = lost - before_cut;
}

void ScanAssembler::follow_direction(double ticks_per_ns, const SensorClock& clock) {
  if (ticks_per_ns * direction_ >= 0.0) {
    against_ = 0;
    return;
  }
  ++against_;
  if (has_column_ && against_ < kAgainstPackets) return;
  interrupt(clock);
  direction_ = -direction_;
  blind_ = BlindSector();
  against_ = 0;
}

// How far the head turned since the column before: the azimuths say it up to whole turns, the
// stamps and the speed say how many turns. Negative when it went back a little.
double ScanAssembler::sweep_to(double phase, std::int64_t column_ns, double ticks_per_ns) const {
  double step = phase - phase_;
  if (step < -kBackwardTicks) step += kTurn;
  if (step > kTurn - kBackwardTicks) step -= kTurn;
  const double expected = std::abs(ticks_per_ns) * static_cast<double>(column_ns - column_ns_);
  return step + kTurn * std::max(0.0, std::round((expected - step) / kTurn));
}

void ScanAssembler::add_column(const PacketDecoder& decoder, std::size_t column,
                               std::int64_t line_ns, SensorClock& clock) {
  const Column& c = decoder.columns()[column];
  std::int64_t column_ns = line_ns + c.first_ns;
  if (has_column_ && column_ns <= last_firing_ns_) {
    if (column_ns < last_firing_ns_ - kStampJitterNs) return;  // nearer than packets can be
    column_ns = last_firing_ns_ + 1;
  }
  const double phase = phase_of(c.azimuth_ticks);
  if (has_column_) {
    const double sweep = sweep_to(phase, column_ns, decoder.ticks_per_ns());
    if (column > 0 && decoder.inner_gap_ns() > 0)
      blind_.see_gap({phase_, sweep}, std::abs(decoder.ticks_per_ns()) * decoder.packet_period_ns(),
                     0);
    if (phase_ + sweep >= kTurn) {
      follows_scan_ = in_scan_;
      if (in_scan_) end_scan(clock, true);
      cuts_passed_ += static_cast<std::uint64_t>((phase_ + sweep) / kTurn);
      // What is left of a revolution after a long gap is a fragment: no map should begin with it.
      if (column_ns - column_ns_ <= kMaxScanNs) {
        begin_scan(decoder, column_ns, clock);
      } else {
        lost_after_cut_ = 0;  // outside of scans
      }
    }
    if (sweep >= 0.0) phase_ = phase;
  } else {
    phase_ = phase;
    has_column_ = true;
  }
  blind_.see_column(phase);
  column_ns_ = column_ns;
  last_firing_ns_ = column_ns + c.last_ns - c.first_ns;
  if (!in_scan_) return;
  if (column_ns - scan_start_ns_ > kMaxScanNs) {
    ++stalls_;
    interrupt(clock);
    return;
  }
  coverage_.mark(phase);
  scan_end_ns_ = last_firing_ns_;
  decoder.append(column, static_cast<std::int32_t>(column_ns - scan_start_ns_), scan_->returns);
}

void ScanAssembler::begin_scan(const PacketDecoder& decoder, std::int64_t column_ns,
                               SensorClock& clock) {
  clock.begin_scan(column_ns);
  scan_->clear();
  scan_->index = cuts_passed_ - 1;
  scan_->beams = decoder.beams();
  // All at once, or it would grow in the middle of revolutions whenever there is more to see.
  const std::size_t most = max_scan_returns(decoder);
  if (scan_->returns.capacity() < most) scan_->returns.reserve(most + most / 8);
  in_scan_ = true;
  scan_start_ns_ = column_ns;
  scan_end_ns_ = column_ns;
  coverage_.clear();
  counts_ = {.lost = lost_after_cut_};
  lost_after_cut_ = 0;
}

// Where nothing is ever sent, nothing is missing.
Coverage::Hole ScanAssembler::largest_hole() const {
  const auto sector = blind_.sector();
  if (!sector) return coverage_.largest_hole();
  Coverage coverage = coverage_;
  for (double ticks = 0.0; ticks <= sector->width_ticks; ticks += Coverage::kTicksPerBin)
    coverage.mark(wrap_ticks(sector->start_ticks + ticks));
  coverage.mark(wrap_ticks(sector->start_ticks + sector->width_ticks));
  return coverage.largest_hole();
}

void ScanAssembler::end_scan(const SensorClock& clock, bool whole) {
  const Coverage::Hole hole = largest_hole();
  Scan& scan = *scan_;
  scan.start_ns = clock.to_utc_ns(scan_start_ns_);
  scan.end_ns = clock.to_utc_ns(scan_end_ns_);
  scan.clock = clock.source();
  scan.complete = whole && hole.width_ticks <= max_hole_ticks_;
  scan.coverage_rad = static_cast<float>(coverage_.covered_ticks() * wire::kRadPerTick);
  if (hole.width_ticks > 0.0) {
    scan.hole_start_rad = ccw_rad_from_ticks(cut_ticks_ + direction_ * hole.start_ticks);
    scan.hole_width_rad = static_cast<float>(hole.width_ticks * wire::kRadPerTick);
  }
  scan.packets = counts_;
  scan.packets.expected = counts_.received + counts_.lost;
  ++(scan.complete ? scans_complete_ : scans_partial_);
  in_scan_ = false;
  scan_ = &sink_.exchange(scan);
}

void ScanAssembler::interrupt(const SensorClock& clock) {
  if (in_scan_) end_scan(clock, false);
  has_column_ = false;
  lost_after_cut_ = 0;
}

}  // namespace lilo
