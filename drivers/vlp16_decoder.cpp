#include "drivers/vlp16_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lilo {
namespace {

constexpr std::int32_t kLaserNs = 2304;
constexpr std::int32_t kSequenceNs = 55296;
constexpr std::int32_t kBlockNs = 2 * kSequenceNs;
constexpr double kMinStepTicks = 10.0;  // 150 rpm: slower is no turning
constexpr double kMinGapTicks = 500.0;
constexpr double kSpeedNoise = 0.02, kMeanPackets = 50.0;
constexpr double kOriginRadiusM = 0.04191;
constexpr double kMaxStepTicks = 500.0;  // 7500 rpm: no head turns like that, the packet is wrong

// Elevation by channel, degrees. VLP-16 manual table 9-1; Hi-Res manual table 9-1.
using Elevations = std::array<double, Vlp16Decoder::kLasers>;
constexpr Elevations kVlp16Deg = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
constexpr Elevations kHiResDeg = {-10.00, 0.67, -8.67, 2.00, -7.33, 3.33, -6.00, 4.67,
                                  -4.67,  6.00, -3.33, 7.33, -2.00, 8.67, -0.67, 10.00};

constexpr std::uint8_t kFactoryStrongest = 0x37, kFactoryLast = 0x38, kFactoryDual = 0x39;

int blocks_per_shot(ReturnMode mode) { return mode == ReturnMode::dual ? 2 : 1; }

}  // namespace

Vlp16Decoder::Vlp16Decoder(const SensorConfig& config, const AzimuthTable& azimuths)
    : azimuths_(azimuths),
      min_steps_(std::max(1, static_cast<int>(std::ceil(config.min_range_m / 0.002)))),
      max_steps_(static_cast<int>(std::min(65535.0, config.max_range_m / 0.002))),
      choice_(config.returns) {
  set_product(kProductVlp16);
}

void Vlp16Decoder::set_product(std::uint8_t product_id) {
  product_id_ = product_id;
  const Elevations& deg = product_id == kProductHiRes ? kHiResDeg : kVlp16Deg;
  std::array<std::size_t, kLasers> by_elevation{};
  std::iota(by_elevation.begin(), by_elevation.end(), 0U);
  std::sort(by_elevation.begin(), by_elevation.end(),
            [&](std::size_t a, std::size_t b) { return deg[a] < deg[b]; });
  beams_.ring_count = kLasers;
  for (std::size_t ring = 0; ring < kLasers; ++ring) {
    const std::size_t laser = by_elevation[ring];
    const double w = deg[laser] * std::numbers::pi / 180.0;
    ring_[laser] = static_cast<std::uint8_t>(ring);
    beams_.elevation_rad[ring] = static_cast<float>(w);
    beam_[laser] = {static_cast<float>(std::cos(w)), static_cast<float>(std::sin(w)),
                    static_cast<float>(kOriginRadiusM * std::tan(-w))};
  }
}

bool Vlp16Decoder::load(DataPacket packet) {
  for (int b = 0; b < wire::kBlocks; ++b) {
    if (wire::block_flag(packet.data(), b) != wire::kUpperFlag) return false;
    if (wire::block_azimuth(packet.data(), b) >= wire::kTicksPerTurn) return false;
  }
  packet_ = packet.data();
  const std::uint8_t product = wire::u8(packet_ + wire::kTailOffset + 1);
  // Firmware before 3.0.29 leaves these bytes to chance (manual, 9.3.1.4): keep the last known.
  const bool known = product == kProductVlp16 || product == kProductHiRes;
  if (known && product != product_id_) set_product(product);
  mode_ = find_mode(packet_);
  measure_turn(packet_);
  find_gap(packet_);
  place_columns(packet_);
  return true;
}

ReturnMode Vlp16Decoder::find_mode(const std::byte* packet) const {
  switch (wire::u8(packet + wire::kTailOffset)) {
    case kFactoryStrongest:
      return ReturnMode::strongest;
    case kFactoryLast:
      return ReturnMode::last;
    case kFactoryDual:
      return ReturnMode::dual;
    default:
      break;
  }
  const bool pairs = wire::block_azimuth(packet, 0) == wire::block_azimuth(packet, 1) &&
                     wire::block_azimuth(packet, 2) == wire::block_azimuth(packet, 3) &&
                     wire::block_azimuth(packet, 0) != wire::block_azimuth(packet, 2);
  return pairs ? ReturnMode::dual : ReturnMode::strongest;
}

void Vlp16Decoder::measure_turn(const std::byte* packet) {
  const int stride = blocks_per_shot(mode_);
  std::array<int, wire::kBlocks> steps{};
  std::size_t count = 0;
  for (int b = stride; b < wire::kBlocks; b += stride)
    steps[count++] =
        short_way_ticks(wire::block_azimuth(packet, b - stride), wire::block_azimuth(packet, b));
  const double step = typical_step({steps.data(), count});
  ticks_per_ns_ = std::abs(step) <= kMaxStepTicks ? step / kBlockNs : 0.0;
  for (int c = 0; c < wire::kChannelsPerBlock; ++c) {
    const int delay_ns = (c / kLasers) * kSequenceNs + (c % kLasers) * kLaserNs;
    const auto a = static_cast<float>(ticks_per_ns_ * delay_ns * wire::kRadPerTick);
    const auto i = static_cast<std::size_t>(c);
    turn_.rad[i] = a;  // at most 0.1 rad, where these series are exact to float
    turn_.cos[i] = 1.0F - a * a * (0.5F - a * a / 24.0F);
    turn_.sin[i] = a - a * a * a * (1.0F / 6.0F - a * a / 120.0F);
  }
}

// A sensor that fires in a part of its turn goes on filling the packet where the part begins again:
// one step of azimuth is far larger than the others, and took as much longer.
void Vlp16Decoder::find_gap(const std::byte* packet) {
  gap_block_ = 0;
  gap_ns_ = 0;
  const double step = std::abs(ticks_per_ns_) * kBlockNs;
  if (step < kMinStepTicks) return;
  // A packet's own speed has the noise of a tick, 0.2 percent: too much for half a turn.
  const double apart = ticks_per_ns_ - mean_ticks_per_ns_;
  const bool settled = std::abs(apart) < kSpeedNoise * std::abs(mean_ticks_per_ns_);
  mean_ticks_per_ns_ = settled ? mean_ticks_per_ns_ + apart / kMeanPackets : ticks_per_ns_;
  const double speed = std::abs(mean_ticks_per_ns_);
  const int stride = blocks_per_shot(mode_), direction = ticks_per_ns_ > 0.0 ? 1 : -1;
  for (int b = stride; b < wire::kBlocks; b += stride) {
    const double turned = wrap_ticks(
        direction * (wire::block_azimuth(packet, b) - wire::block_azimuth(packet, b - stride)));
    const bool back = turned > wire::kTicksPerTurn - kMinGapTicks;  // noise, or nonsense
    if (back || turned < step + kMinGapTicks) continue;
    const bool second = gap_block_ != 0;
    gap_block_ = second ? 0 : b;
    gap_ns_ = second ? 0 : static_cast<std::int32_t>((turned - step) / speed);
    if (second) return;  // nobody knows what this is
  }
}

void Vlp16Decoder::place_columns(const std::byte* packet) {
  const int stride = blocks_per_shot(mode_);
  column_count_ = 0;
  for (int b = 0; b < wire::kBlocks; b += stride) {
    const double azimuth = wire::block_azimuth(packet, b);
    for (int sequence = 0; sequence < 2; ++sequence) {
      const std::int32_t waited_ns = gap_block_ > 0 && b >= gap_block_ ? gap_ns_ : 0;
      const std::int32_t first_ns = (b / stride) * kBlockNs + sequence * kSequenceNs + waited_ns;
      columns_[column_count_++] = {
          .azimuth_ticks = wrap_ticks(azimuth + sequence * ticks_per_ns_ * kSequenceNs),
          .first_ns = first_ns,
          .last_ns = first_ns + (kLasers - 1) * kLaserNs};
    }
  }
}

double Vlp16Decoder::packet_period_ns() const {
  return static_cast<double>(kBlockNs) * wire::kBlocks / blocks_per_shot(mode_);
}

void Vlp16Decoder::append(std::size_t column, std::int32_t t_ns, std::vector<Return>& out) const {
  const int shot = static_cast<int>(column) / 2;
  const int sequence = static_cast<int>(column) % 2;
  std::array<Return, kLasers> first;
  std::array<Echo, kLasers> first_echo;
  if (mode_ != ReturnMode::dual) {
    const ReturnKind kind = mode_ == ReturnMode::last ? ReturnKind::last : ReturnKind::strongest;
    project(wire::block(packet_, shot), sequence, t_ns, kind, first, first_echo);
    keep_in_range(first, first_echo, out);
    return;
  }
  // Even blocks hold the last echo, odd ones the strongest, or the second strongest where the last
  // is the strongest; equal ones are one echo (manual, 9.3.1.5).
  std::array<Return, kLasers> second;
  std::array<Echo, kLasers> second_echo;
  project(wire::block(packet_, 2 * shot), sequence, t_ns, ReturnKind::last, first, first_echo);
  project(wire::block(packet_, 2 * shot + 1), sequence, t_ns, ReturnKind::strongest, second,
          second_echo);
  merge_dual(first, first_echo, second, second_echo, out);
}

void Vlp16Decoder::project(const std::byte* block, int sequence, std::int32_t t_ns, ReturnKind kind,
                           std::array<Return, kLasers>& returns,
                           std::array<Echo, kLasers>& echoes) const {
  const AzimuthTable::Entry& base = azimuths_[wire::u16(block + 2)];
  const auto turn_offset = static_cast<std::size_t>(sequence) * kLasers;
  const std::byte* channel = block + wire::kBlockHeaderBytes + turn_offset * wire::kChannelBytes;
  for (std::size_t k = 0; k < kLasers; ++k, channel += wire::kChannelBytes) {
    const float turn_cos = turn_.cos[turn_offset + k], turn_sin = turn_.sin[turn_offset + k];
    const float cos_a = base.cos * turn_cos - base.sin * turn_sin;
    const float sin_a = base.sin * turn_cos + base.cos * turn_sin;
    const std::uint16_t steps = wire::u16(channel);
    const float range = static_cast<float>(steps) * wire::kMetresPerStep;
    const float horizontal = range * beam_[k].cos_elevation;
    const float ccw = base.ccw_rad - turn_.rad[turn_offset + k];
    returns[k] = {.x_m = horizontal * cos_a,
                  .y_m = -horizontal * sin_a,
                  .z_m = range * beam_[k].sin_elevation + beam_[k].origin_z_m,
                  .azimuth_rad = wrap_rad(ccw),
                  .t_ns = t_ns + static_cast<std::int32_t>(k) * kLaserNs,
                  .ring = ring_[k],
                  .intensity = wire::u8(channel + 2),
                  .kind = kind};
    echoes[k] = {steps, steps >= min_steps_ && steps <= max_steps_};
  }
}

void Vlp16Decoder::keep_in_range(const std::array<Return, kLasers>& returns,
                                 const std::array<Echo, kLasers>& echoes,
                                 std::vector<Return>& out) {
  std::array<Return, kLasers> kept;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kLasers; ++k) {
    kept[count] = returns[k];
    count += echoes[k].in_range ? 1U : 0U;
  }
  out.insert(out.end(), kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
}

void Vlp16Decoder::merge_dual(const std::array<Return, kLasers>& last,
                              const std::array<Echo, kLasers>& last_echo,
                              const std::array<Return, kLasers>& other,
                              const std::array<Echo, kLasers>& other_echo,
                              std::vector<Return>& out) const {
  std::array<Return, std::size_t{2} * kLasers> kept;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kLasers; ++k) {
    const bool same = last_echo[k].steps == other_echo[k].steps;
    if (same) {
      kept[count] = last[k];
      kept[count].kind = ReturnKind::both;
      count += last_echo[k].in_range ? 1U : 0U;
      continue;
    }
    const bool last_is_strongest = last[k].intensity > other[k].intensity;
    const bool want_last = choice_ != ReturnChoice::strongest || last_is_strongest;
    const bool want_other =
        choice_ == ReturnChoice::both || (choice_ == ReturnChoice::strongest && !want_last);
    kept[count] = last[k];
    count += want_last && last_echo[k].in_range ? 1U : 0U;
    kept[count] = other[k];
    count += want_other && other_echo[k].in_range ? 1U : 0U;
  }
  out.insert(out.end(), kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace lilo
