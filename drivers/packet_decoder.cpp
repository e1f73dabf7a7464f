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

constexpr std::uint8_t kStrongest = 0x37, kLast = 0x38, kDual = 0x39;
// VLS-128: two echoes and a block that says how much to trust them (VeloView).
constexpr std::uint8_t kDualConfirmed = 0x3B;

// A measured cycle is the mean of so many periods, each nearer to the table's than this.
constexpr int kMeanCycles = 256;
constexpr double kCycleTolerance = 0.15;

// The speed over several packets is believed over less than half a turn.
constexpr std::uint32_t kMaxSpanUs = 20'000;
constexpr std::uint32_t kHourUs = 3'600'000'000U;

std::uint8_t mode_byte(const std::byte* packet) { return wire::u8(packet + wire::kTailOffset); }

}  // namespace

PacketDecoder::PacketDecoder(const SensorConfig& config, const AzimuthTable& azimuths)
    : azimuths_(azimuths),
      min_range_m_(config.min_range_m),
      max_range_m_(config.max_range_m),
      choice_(config.returns) {
  use(*find_sensor(SensorModel::vlp16));
}

void PacketDecoder::use(const SensorTable& table) {
  table_ = &table;
  layout_ = {.mode = ReturnMode::strongest, .shots = 0};
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
      table_->elevation_deg.empty() ? calibration.distance_step_m : table_->distance_step_m;
  set_lasers(calibration, step_m, min_range_m_, max_range_m_, lasers_);
  ticks_per_ns_ = 0.0;
  turn_lasers();
}

void PacketDecoder::use_times(const FiringTimes* times) {
  times_ = times;
  if (times == nullptr) return;
  cycle_ns_ = times->cycle_ns;
  last_delay_ns_ = *std::max_element(times->laser_ns.begin(), times->laser_ns.end());
  const auto lasers = static_cast<std::size_t>(table_->lasers);
  for (std::size_t i = 0; i < angle_count_; ++i) {
    const auto cycle = static_cast<std::int32_t>(i / lasers);
    delay_ns_[i] =
        table_->turns_within_block ? cycle * times->cycle_ns + times->laser_ns[i % lasers] : 0;
  }
}

bool PacketDecoder::load(DataPacket packet) {
  const Layout layout = find_layout(packet.data());
  if (!is_whole(packet.data(), layout)) return false;
  packet_ = packet.data();
  layout_ = layout;
  column_count_ = 0;
  ticks_per_ns_ = 0.0;
  if (times_ == nullptr) return true;
  if (table_->cycle_varies) follow_cycle(wire::u32(packet_ + wire::kStampOffset));
  measure_speed();
  if (table_->turns_within_block) turn_lasers();
  find_gap();
  place_columns();
  return true;
}

PacketDecoder::Layout PacketDecoder::find_layout(const std::byte* packet) const {
  Layout layout{.mode = find_mode(packet)};
  if (layout.mode == layout_.mode && layout_.shots > 0 && !table_->has_confidence) return layout_;
  const bool dual = layout.mode == ReturnMode::dual;
  const bool neighbours = table_->echoes == EchoOrder::last_then_strongest;
  if (dual && neighbours) {
    layout.bank_stride = table_->has_confidence && mode_byte(packet) == kDualConfirmed ? 3 : 2;
    layout.echo_stride = 1;
    layout.blocks_per_shot = layout.bank_stride * table_->banks;
  } else {
    layout.echo_stride = table_->banks;
    layout.blocks_per_shot = (dual ? 2 : 1) * table_->banks;
  }
  layout.shots = wire::kBlocks / layout.blocks_per_shot;
  return layout;
}

ReturnMode PacketDecoder::find_mode(const std::byte* packet) const {
  if (table_->product == 0) return find_mode_by_azimuths(packet);
  switch (mode_byte(packet)) {
    case kStrongest:
      return ReturnMode::strongest;
    case kLast:
      return ReturnMode::last;
    case kDual:
      return ReturnMode::dual;
    case kDualConfirmed:
      if (table_->has_confidence) return ReturnMode::dual;
      break;
    default:
      break;
  }
  return find_mode_by_azimuths(packet);
}

// In dual return mode the two echoes' blocks have one azimuth. Where the head stands all have.
ReturnMode PacketDecoder::find_mode_by_azimuths(const std::byte* packet) const {
  const int apart = table_->echoes == EchoOrder::last_then_strongest ? 1 : table_->banks;
  const int shot = 2 * table_->banks;
  const auto same = [&](int i, int j) {
    return wire::block_azimuth(packet, i) == wire::block_azimuth(packet, j);
  };
  if (table_->product == 0) {
    const bool pairs = same(0, apart) && same(shot, shot + apart) && same(8, 8 + apart);
    const bool still = same(0, shot) && same(shot, 8);
    const bool dual = still ? is_dual() : pairs;
    return dual ? ReturnMode::dual : ReturnMode::strongest;
  }
  if (table_->banks > 1) {
    const bool twice = wire::block_flag(packet, 0) == wire::block_flag(packet, 1);
    return twice ? ReturnMode::dual : ReturnMode::strongest;
  }
  const bool pairs = same(0, 1) && same(2, 3) && !same(0, 2);
  return pairs ? ReturnMode::dual : ReturnMode::strongest;
}

bool PacketDecoder::is_whole(const std::byte* packet, const Layout& layout) const {
  // With confidence each bank has a third block, which holds no returns.
  const int echoes = std::min(layout.bank_stride, 2);
  const int used = layout.shots * layout.blocks_per_shot;
  for (int first = 0; first < used;) {
    for (int bank = 0; bank < table_->banks; ++bank, first += layout.bank_stride) {
      for (int b = first; b < first + echoes; ++b) {
        if (wire::block_flag(packet, b) != table_->bank_flags[static_cast<std::size_t>(bank)])
          return false;
        if (wire::block_azimuth(packet, b) >= wire::kTicksPerTurn) return false;
      }
    }
  }
  return true;
}

int PacketDecoder::shot_azimuth(int shot) const {
  return wire::block_azimuth(packet_, shot * layout_.blocks_per_shot);
}

void PacketDecoder::follow_cycle(std::uint32_t stamp_us) {
  const int cycles = layout_.shots * table_->cycles_per_block;
  const double cycle_ns = (stamp_us - last_stamp_us_) * 1e3 / cycles;
  last_stamp_us_ = stamp_us;
  if (std::abs(cycle_ns / times_->cycle_ns - 1.0) > kCycleTolerance) return;
  cycles_seen_ = std::min(cycles_seen_ + 1, kMeanCycles);
  cycle_ns_ += (cycle_ns - cycle_ns_) / cycles_seen_;
}

void PacketDecoder::measure_speed() {
  const double shot_ns = cycle_ns_ * table_->cycles_per_block;
  const double step = layout_.shots > 1 ? speed_within_packet() : speed_over_packets() * shot_ns;
  const bool possible = std::abs(step) * kPerBlockNs <= kMaxStepTicks * shot_ns;
  ticks_per_ns_ = possible ? step / shot_ns : 0.0;
}

// In ticks from shot to shot.
double PacketDecoder::speed_within_packet() const {
  std::array<int, wire::kBlocks> steps{};
  std::size_t count = 0;
  for (int s = 1; s < layout_.shots; ++s)
    steps[count++] = short_way_ticks(shot_azimuth(s - 1), shot_azimuth(s));
  return typical_step({steps.data(), count});
}

// One shot a packet: from the oldest packet remembered to this one, whatever was lost between.
double PacketDecoder::speed_over_packets() {
  const Instant now{wire::u32(packet_ + wire::kStampOffset), shot_azimuth(0)};
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

void PacketDecoder::turn_lasers() {
  const bool offset = lasers_.largest_rot_rad > 0.0F;
  for (std::size_t i = 0; i < angle_count_; ++i) {
    const auto a = static_cast<float>(ticks_per_ns_ * delay_ns_[i] * wire::kRadPerTick);
    angles_.rad[i] = a;  // at most 0.1 rad, where these series are exact to float
    angles_.cos[i] = 1.0F - a * a * (0.5F - a * a / 24.0F);
    angles_.sin[i] = a - a * a * a * (1.0F / 6.0F - a * a / 120.0F);
  }
  const double last_ns = angle_count_ > 0 ? delay_ns_[angle_count_ - 1] : 0;
  angles_.largest_rad = std::abs(static_cast<float>(ticks_per_ns_ * last_ns * wire::kRadPerTick)) +
                        lasers_.largest_rot_rad;
  if (!offset) return;
  const auto lasers = static_cast<std::size_t>(table_->lasers);
  for (std::size_t i = 0; i < angle_count_; ++i) {
    const std::size_t k = i < lasers ? i : i - lasers;
    const float cos = angles_.cos[i], sin = angles_.sin[i];
    angles_.cos[i] = cos * lasers_.cos_rot[k] + sin * lasers_.sin_rot[k];
    angles_.sin[i] = sin * lasers_.cos_rot[k] - cos * lasers_.sin_rot[k];
    angles_.rad[i] -= lasers_.rot_rad[k];
  }
}

// A sensor that fires in a part of its turn goes on filling the packet where the part begins again:
// one step of azimuth is far larger than the others, and took as much longer. (With the stamp at
// the packet's end nobody knows which packets are longer.)
void PacketDecoder::find_gap() {
  gap_shot_ = 0;
  gap_ns_ = 0;
  if (table_->stamp_is_packet_end || layout_.shots < 2) return;
  if (std::abs(ticks_per_ns_) * kPerBlockNs < kMinStepTicks) return;
  const double step = std::abs(ticks_per_ns_) * cycle_ns_ * table_->cycles_per_block;
  // A packet's own speed has the noise of a tick, 0.2 percent: too much for half a turn.
  const double apart = ticks_per_ns_ - mean_ticks_per_ns_;
  const bool settled = std::abs(apart) < kSpeedNoise * std::abs(mean_ticks_per_ns_);
  mean_ticks_per_ns_ = settled ? mean_ticks_per_ns_ + apart / kMeanPackets : ticks_per_ns_;
  const double speed = std::abs(mean_ticks_per_ns_);
  const int direction = ticks_per_ns_ > 0.0 ? 1 : -1;
  for (int s = 1; s < layout_.shots; ++s) {
    const double turned = wrap_ticks(direction * (shot_azimuth(s) - shot_azimuth(s - 1)));
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
  const std::int32_t shot_ns = cycle_ns * table_->cycles_per_block;
  const std::int32_t begin_ns =
      table_->first_firing_ns - (table_->stamp_is_packet_end ? layout_.shots * shot_ns : 0);
  for (int s = 0; s < layout_.shots; ++s) {
    const double azimuth = shot_azimuth(s);
    const std::int32_t waited_ns = gap_shot_ > 0 && s >= gap_shot_ ? gap_ns_ : 0;
    for (int cycle = 0; cycle < table_->cycles_per_block; ++cycle) {
      const std::int32_t first_ns = begin_ns + s * shot_ns + cycle * cycle_ns + waited_ns;
      columns_[column_count_++] = {
          .azimuth_ticks = wrap_ticks(azimuth + cycle * ticks_per_ns_ * cycle_ns),
          .first_ns = first_ns,
          .last_ns = first_ns + last_delay_ns_};
    }
  }
}

double PacketDecoder::packet_period_ns() const {
  return times_ == nullptr ? 0.0 : cycle_ns_ * layout_.shots * table_->cycles_per_block;
}

std::size_t PacketDecoder::max_column_returns() const {
  const bool twice = is_dual() && choice_ == ReturnChoice::both;
  return static_cast<std::size_t>(table_->lasers) * (twice ? 2 : 1);
}

}  // namespace lilo
