// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_decoder.hpp"

#include <algorithm>
#include <cmath>

namespace lilo {
namespace {

// What follows was found at a VLP-16's step from block to block.
constexpr double kPerBlockNs = 110'592.0;
constexpr double kMinStepTicks = 10.0;  // 150 rpm: slower is no turning
constexpr double kMinGapTicks = 500.0;
constexpr double kSpeedNoise = 0.02, kMeanPackets = 50.0;
constexpr double kMaxStepTicks = 500.0;  // 7500 rpm: no head turns like that, the packet is wrong

// A measured cycle is the mean of so many periods, each nearer to the table's than this.
constexpr int kMeanCycles = 256;
constexpr double kCycleTolerance = 0.15;

// The speed over several packets is believed over less than half a turn.
constexpr std::uint32_t kMaxSpanUs = 20'000;
constexpr std::uint32_t kHourUs = 3'600'000'000U;

}  // namespace

PacketDecoder::PacketDecoder(const SensorConfig& config, const AzimuthTable& azimuths)
    : min_range_m_(config.min_range_m), max_range_m_(config.max_range_m) {
  packet_.azimuths = &azimuths;
  packet_.choice = config.returns;
  use(*find_sensor(SensorModel::vlp16));
}

void PacketDecoder::use(const SensorTable& table) {
  packet_.table = &table;
  packet_.layout = {};
  cycles_seen_ = 0;
  instant_count_ = 0;
  mean_ticks_per_ns_ = 0.0;
  angle_count_ =
      static_cast<std::size_t>(table.lasers) * static_cast<std::size_t>(table.cycles_per_block);
  use_times(table.times.size() == 1 ? &table.times.front() : nullptr);
  if (!table.elevation_deg.empty()) use_calibration(built_in_calibration(table));
}

void PacketDecoder::use_calibration(const Calibration& calibration) {
  const double step_m =
      table().elevation_deg.empty() ? calibration.distance_step_m : table().distance_step_m;
  set_lasers(calibration, step_m, min_range_m_, max_range_m_, packet_.lasers);
  ticks_per_ns_ = 0.0;
  turn_to_speed();
}

void PacketDecoder::use_times(const FiringTimes* times) {
  packet_.times = times;
  if (times == nullptr) return;
  cycle_ns_ = times->cycle_ns;
  last_delay_ns_ = *std::max_element(times->laser_ns.begin(), times->laser_ns.end());
  const auto lasers = static_cast<std::size_t>(table().lasers);
  for (std::size_t i = 0; i < angle_count_; ++i) {
    const auto cycle = static_cast<std::int32_t>(i / lasers);
    delay_ns_[i] =
        table().turns_within_block ? cycle * times->cycle_ns + times->laser_ns[i % lasers] : 0;
  }
}

bool PacketDecoder::load(DataPacket packet) {
  const PacketLayout layout = find_layout(table(), packet.data(), packet_.layout);
  if (!is_whole(table(), packet.data(), layout)) return false;
  packet_.bytes = packet.data();
  packet_.layout = layout;
  column_count_ = 0;
  ticks_per_ns_ = 0.0;
  if (packet_.times == nullptr) return true;
  if (table().cycle_varies) follow_cycle(wire::u32(packet_.bytes + wire::kStampOffset));
  measure_speed();
  if (table().turns_within_block) turn_to_speed();
  find_gap();
  place_columns();
  return true;
}

void PacketDecoder::follow_cycle(std::uint32_t stamp_us) {
  const int cycles = packet_.layout.shots * table().cycles_per_block;
  const double cycle_ns = (stamp_us - last_stamp_us_) * 1e3 / cycles;
  last_stamp_us_ = stamp_us;
  if (std::abs(cycle_ns / packet_.times->cycle_ns - 1.0) > kCycleTolerance) return;
  cycles_seen_ = std::min(cycles_seen_ + 1, kMeanCycles);
  cycle_ns_ += (cycle_ns - cycle_ns_) / cycles_seen_;
}

void PacketDecoder::measure_speed() {
  const double shot_ns = cycle_ns_ * table().cycles_per_block;
  const double step =
      packet_.layout.shots > 1 ? speed_within_packet() : speed_over_packets() * shot_ns;
  const bool possible = std::abs(step) * kPerBlockNs <= kMaxStepTicks * shot_ns;
  ticks_per_ns_ = possible ? step / shot_ns : 0.0;
}

// In ticks from shot to shot.
double PacketDecoder::speed_within_packet() const {
  std::array<int, wire::kBlocks> steps{};
  std::size_t count = 0;
  for (int s = 1; s < packet_.layout.shots; ++s)
    steps[count++] = short_way_ticks(azimuth_of(s - 1), azimuth_of(s));
  return typical_step({steps.data(), count});
}

// One shot a packet: from the oldest packet remembered to this one, whatever was lost between.
double PacketDecoder::speed_over_packets() {
  const Instant now{wire::u32(packet_.bytes + wire::kStampOffset), azimuth_of(0)};
  double ticks_per_ns = mean_ticks_per_ns_;
  for (std::size_t back = std::min(instant_count_, kInstants); back > 0; --back) {
    const Instant& then = instants_[(instant_count_ - back) % kInstants];
    const std::uint32_t span_us = now.stamp_us >= then.stamp_us
                                      ? now.stamp_us - then.stamp_us
                                      : now.stamp_us + kHourUs - then.stamp_us;
    if (span_us == 0 || span_us > kMaxSpanUs) continue;
    ticks_per_ns = short_way_ticks(then.azimuth, now.azimuth) / (span_us * 1e3);
    break;
  }
  instants_[instant_count_++ % kInstants] = now;
  mean_ticks_per_ns_ = ticks_per_ns;
  return ticks_per_ns;
}

void PacketDecoder::turn_to_speed() {
  turn_lasers(packet_.lasers, table().lasers, {delay_ns_.data(), angle_count_}, ticks_per_ns_,
              packet_.angles);
}

// A sensor that fires in a part of its turn goes on filling the packet where the part begins again:
// one step of azimuth is far larger than the others, and took as much longer. (With the stamp at
// the packet's end nobody knows which packets are longer.)
void PacketDecoder::find_gap() {
  gap_shot_ = 0;
  gap_ns_ = 0;
  if (table().stamp_is_packet_end || packet_.layout.shots < 2) return;
  if (std::abs(ticks_per_ns_) * kPerBlockNs < kMinStepTicks) return;
  const double step = std::abs(ticks_per_ns_) * cycle_ns_ * table().cycles_per_block;
  // A packet's own speed has the noise of a tick, 0.2 percent: too much for half a turn.
  const double apart = ticks_per_ns_ - mean_ticks_per_ns_;
  const bool settled = std::abs(apart) < kSpeedNoise * std::abs(mean_ticks_per_ns_);
  mean_ticks_per_ns_ = settled ? mean_ticks_per_ns_ + apart / kMeanPackets : ticks_per_ns_;
  const double speed = std::abs(mean_ticks_per_ns_);
  const int direction = ticks_per_ns_ > 0.0 ? 1 : -1;
  for (int s = 1; s < packet_.layout.shots; ++s) {
    const double turned = wrap_ticks(direction * (azimuth_of(s) - azimuth_of(s - 1)));
    const bool back = turned > wire::kTicksPerTurn - kMinGapTicks;  // noise, or nonsense
    if (back || turned < step + kMinGapTicks) continue;
    const bool second = gap_shot_ != 0;
    gap_shot_ = second ? 0 : s;
    gap_ns_ = second ? 0 : static_cast<std::int32_t>((turned - step) / speed);
    if (second) return;  // nobody knows what this is
  }
}

void PacketDecoder::place_columns() {
  const auto cycle_ns = static_cast<std::int32_t>(std::lround(cycle_ns_));
  const std::int32_t shot_ns = cycle_ns * table().cycles_per_block;
  const std::int32_t begin_ns =
      table().first_firing_ns - (table().stamp_is_packet_end ? packet_.layout.shots * shot_ns : 0);
  for (int s = 0; s < packet_.layout.shots; ++s) {
    const double azimuth = azimuth_of(s);
    const std::int32_t waited_ns = gap_shot_ > 0 && s >= gap_shot_ ? gap_ns_ : 0;
    for (int cycle = 0; cycle < table().cycles_per_block; ++cycle) {
      const std::int32_t first_ns = begin_ns + s * shot_ns + cycle * cycle_ns + waited_ns;
      columns_[column_count_++] = {
          .azimuth_ticks = wrap_ticks(azimuth + cycle * ticks_per_ns_ * cycle_ns),
          .first_ns = first_ns,
          .last_ns = first_ns + last_delay_ns_};
    }
  }
}

double PacketDecoder::packet_period_ns() const {
  return packet_.times == nullptr ? 0.0
                                  : cycle_ns_ * packet_.layout.shots * table().cycles_per_block;
}

std::size_t PacketDecoder::max_column_returns() const {
  const bool twice = is_dual() && packet_.choice == ReturnChoice::both;
  return static_cast<std::size_t>(table().lasers) * (twice ? 2 : 1);
}

}  // namespace lilo
