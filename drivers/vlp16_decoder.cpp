#include "drivers/vlp16_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
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
    beams_.elevation_rad[ring] = static_cast<float>(w);
    beam_.ring[laser] = static_cast<std::int32_t>(ring);
    beam_.cos_elevation[laser] = static_cast<float>(std::cos(w));
    beam_.sin_elevation[laser] = static_cast<float>(std::sin(w));
    beam_.origin_z_m[laser] = static_cast<float>(kOriginRadiusM * std::tan(-w));
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
  turn_.largest_rad = std::abs(turn_.rad.back());
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

void Vlp16Decoder::append(std::size_t column, std::int32_t t_ns, Returns& out) const {
  const int shot = static_cast<int>(column) / 2;
  const int sequence = static_cast<int>(column) % 2;
  if (mode_ == ReturnMode::dual) {
    append_dual(shot, sequence, t_ns, out);
  } else {
    append_single(shot, sequence, t_ns, out);
  }
}

Vlp16Decoder::Sequence Vlp16Decoder::project(int block, int sequence) const {
  const std::byte* bytes = wire::block(packet_, block);
  const auto first = static_cast<std::size_t>(sequence) * kLasers;
  const auto raw = channels<kLasers>(bytes + wire::kBlockHeaderBytes + first * wire::kChannelBytes);
  const AzimuthTable::Entry base = azimuths_[wire::u16(bytes + 2)];
  Sequence seen;
  const std::int32_t min_steps = min_steps_, max_steps = max_steps_;
  // No branches here, and nothing the compiler may not compute for four lasers at once.
  for (std::size_t k = 0; k < kLasers; ++k) {
    const float turn_cos = turn_.cos[first + k], turn_sin = turn_.sin[first + k];
    const float cos_a = base.cos * turn_cos - base.sin * turn_sin;
    const float sin_a = base.sin * turn_cos + base.cos * turn_sin;
    const std::int32_t steps = raw[k] & 0xFFFF;
    const float range = static_cast<float>(steps) * wire::kMetresPerStep;
    const float horizontal = range * beam_.cos_elevation[k];
    seen.x_m[k] = horizontal * cos_a;
    seen.y_m[k] = -horizontal * sin_a;
    seen.z_m[k] = range * beam_.sin_elevation[k] + beam_.origin_z_m[k];
    seen.azimuth_rad[k] = base.ccw_rad - turn_.rad[first + k];
    seen.ring_and_intensity[k] = beam_.ring[k] | raw[k] >> 16 << 8;
    seen.steps[k] = steps;
    seen.in_range[k] = static_cast<std::int32_t>(steps >= min_steps) &
                       static_cast<std::int32_t>(steps <= max_steps);
  }
  wrap_around(base.ccw_rad, turn_.largest_rad, seen.azimuth_rad);
  return seen;
}

void Vlp16Decoder::append_single(int block, int sequence, std::int32_t t_ns, Returns& out) const {
  const ReturnKind kind = mode_ == ReturnMode::last ? ReturnKind::last : ReturnKind::strongest;
  const Sequence seen = project(block, sequence);
  Kept<kLasers> kept(out);
  for (std::size_t k = 0; k < kLasers; ++k, t_ns += kLaserNs) {
    kept.add(seen, k, t_ns, kind, seen.in_range[k]);
  }
}

// Even blocks hold the last echo, odd ones the strongest, or the second strongest where the last
// is the strongest; equal ones are one echo (manual, 9.3.1.5).
void Vlp16Decoder::append_dual(int shot, int sequence, std::int32_t t_ns, Returns& out) const {
  const Sequence last = project(2 * shot, sequence), other = project(2 * shot + 1, sequence);
  Kept<std::size_t{2} * kLasers> kept(out);
  for (std::size_t k = 0; k < kLasers; ++k, t_ns += kLaserNs) {
    const bool same = last.steps[k] == other.steps[k];
    const bool last_is_strongest = last.intensity(k) > other.intensity(k);
    const bool want_last = same || choice_ != ReturnChoice::strongest || last_is_strongest;
    const bool want_other = !same && (choice_ == ReturnChoice::both ||
                                      (choice_ == ReturnChoice::strongest && !want_last));
    kept.add(last, k, t_ns, same ? ReturnKind::both : ReturnKind::last,
             want_last ? last.in_range[k] : 0);
    kept.add(other, k, t_ns, ReturnKind::strongest, want_other ? other.in_range[k] : 0);
  }
}

}  // namespace lilo
