#include "drivers/hdl64e_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

// Debian is compiled for processors that take four lasers at a time. Where one takes eight, a
// second version is called; it rounds as the first does, so the returns are the same bits. A
// program under ThreadSanitizer crashes when it chooses between the two.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define LILO_EIGHT_LANES __attribute__((target_clones("avx2", "default")))
#else
#define LILO_EIGHT_LANES
#endif

namespace lilo {
namespace {

constexpr FiringTable kS2{48000, 6000, {0, 1260, 2460, 3660}};
constexpr FiringTable kS3{57600, 7200, {0, 1300, 2500, 3700}};
constexpr double kPeriodTolerance = 0.04;

// Where the near-range corrections were found (manual, dual two point calibration).
constexpr float kFarM = 25.04F, kNearXM = 2.40F, kNearYM = 1.93F;

// The intensity of a laser is weakest where it is out of focus: raw + slope * 256 * |(1 - f/R)^2 -
// (1 - d/R)^2|, R the largest distance a packet can hold (S2 manual, appendix "intensity").
constexpr float kFocalRangeM = 131.07F;

// VeloView counts an HDL-64E's stamp as the end of the packet, others as its beginning; no manual
// page says. It shifts all times alike by one packet.
constexpr bool kStampIsPacketEnd = true;

int shots_per_packet(bool dual) { return dual ? 3 : 6; }

float square(float v) { return v * v; }

}  // namespace

const FiringTable* find_firing_table(double packet_period_ns, bool dual) {
  const double shot_ns = packet_period_ns / shots_per_packet(dual);
  for (const FiringTable* table : {&kS2, &kS3})
    if (std::abs(shot_ns / table->shot_ns - 1.0) < kPeriodTolerance) return table;
  return nullptr;
}

Hdl64eDecoder::Hdl64eDecoder(const SensorConfig& config, const AzimuthTable& azimuths)
    : azimuths_(azimuths),
      min_range_m_(config.min_range_m),
      max_range_m_(config.max_range_m),
      choice_(config.returns) {}

void Hdl64eDecoder::use_calibration(const Hdl64eCalibration& calibration) {
  constexpr std::size_t kLasers = Hdl64eCalibration::kLasers;
  std::array<std::size_t, kLasers> by_elevation{};
  std::iota(by_elevation.begin(), by_elevation.end(), 0U);
  std::sort(by_elevation.begin(), by_elevation.end(), [&](std::size_t a, std::size_t b) {
    return calibration.lasers[a].vert_rad < calibration.lasers[b].vert_rad;
  });
  beams_.ring_count = kLasers;
  lasers_.largest_b_rad = 0.0F;
  step_m_ = static_cast<float>(calibration.distance_step_m);
  for (std::size_t ring = 0; ring < kLasers; ++ring) {
    const std::size_t i = by_elevation[ring];
    const LaserCorrection& c = calibration.lasers[i];
    const auto f = [](double v) { return static_cast<float>(v); };
    const auto steps = [&](double range_m) {
      return static_cast<int>(std::ceil((range_m - c.dist_m) / calibration.distance_step_m));
    };
    const auto near = [&](double near_m, float near_at_m) {
      return c.two_point ? f(near_m - c.dist_m) / (kFarM - near_at_m) : 0.0F;
    };
    beams_.elevation_rad[ring] = f(c.vert_rad);
    lasers_.cos_w[i] = f(std::cos(c.vert_rad));
    lasers_.sin_w[i] = f(std::sin(c.vert_rad));
    lasers_.cos_b[i] = f(std::cos(c.rot_rad));
    lasers_.sin_b[i] = f(std::sin(c.rot_rad));
    lasers_.b_rad[i] = f(c.rot_rad);
    lasers_.dist_m[i] = f(c.dist_m);
    lasers_.near_x[i] = near(c.dist_x_m, kNearXM);
    lasers_.near_y[i] = near(c.dist_y_m, kNearYM);
    lasers_.horizontal_m[i] = f(c.horiz_offset_m);
    lasers_.vertical_m[i] = f(c.vert_offset_m);
    lasers_.focal[i] = square(1.0F - f(c.focal_distance_m) / kFocalRangeM);
    lasers_.slope[i] = 256.0F * f(c.focal_slope);
    lasers_.min_intensity[i] = f(std::clamp(c.min_intensity, 0, 255));
    lasers_.max_intensity[i] = f(std::clamp(c.max_intensity, 0, 255));
    lasers_.min_steps[i] = std::max(1, steps(min_range_m_));
    lasers_.max_steps[i] = steps(max_range_m_);
    lasers_.ring[i] = static_cast<std::int32_t>(ring);
    lasers_.largest_b_rad = std::max(lasers_.largest_b_rad, std::abs(lasers_.b_rad[i]));
  }
}

void Hdl64eDecoder::use_table(const FiringTable* table) {
  table_ = table;
  if (table == nullptr) return;
  for (std::size_t k = 0; k < kBank; ++k) {
    laser_ns_[k] = static_cast<std::int32_t>(k / 4) * table->group_ns + table->laser_ns[k % 4];
  }
}

bool Hdl64eDecoder::find_dual(const std::byte* packet) const {
  const auto same = [&](int i, int j) {
    return wire::block_azimuth(packet, i) == wire::block_azimuth(packet, j);
  };
  const bool pairs = same(0, 2) && same(4, 6) && same(8, 10);
  const bool still = same(0, 4) && same(4, 8);
  return still ? dual_ : pairs;
}

bool Hdl64eDecoder::load(DataPacket packet) {
  for (int b = 0; b < wire::kBlocks; ++b) {
    const std::uint16_t flag = b % 2 == 0 ? wire::kUpperFlag : wire::kLowerFlag;
    if (wire::block_flag(packet.data(), b) != flag) return false;
    if (wire::block_azimuth(packet.data(), b) >= wire::kTicksPerTurn) return false;
  }
  packet_ = packet.data();
  dual_ = find_dual(packet_);
  column_count_ = 0;
  ticks_per_ns_ = 0.0;
  if (table_ == nullptr) return true;
  const int shots = shots_per_packet(dual_);
  const int stride = wire::kBlocks / shots;
  const std::int32_t begin_ns = kStampIsPacketEnd ? -shots * table_->shot_ns : 0;
  const std::int32_t last_laser_ns = 7 * table_->group_ns + table_->laser_ns[3];
  std::array<int, wire::kBlocks / 2> steps{};
  for (int s = 0; s < shots; ++s) {
    const int azimuth = wire::block_azimuth(packet_, s * stride);
    const std::int32_t first_ns = begin_ns + s * table_->shot_ns;
    columns_[column_count_++] = {.azimuth_ticks = static_cast<double>(azimuth),
                                 .first_ns = first_ns,
                                 .last_ns = first_ns + last_laser_ns};
    if (s > 0)
      steps[static_cast<std::size_t>(s - 1)] =
          short_way_ticks(wire::block_azimuth(packet_, (s - 1) * stride), azimuth);
  }
  ticks_per_ns_ = typical_step({steps.data(), column_count_ - 1}) / table_->shot_ns;
  return true;
}

double Hdl64eDecoder::packet_period_ns() const {
  return table_ == nullptr ? 0.0 : static_cast<double>(table_->shot_ns) * shots_per_packet(dual_);
}

LILO_EIGHT_LANES
Hdl64eDecoder::Bank Hdl64eDecoder::project(int block) const {
  const std::byte* bytes = wire::block(packet_, block);
  const std::size_t first_laser = block % 2 == 0 ? 0 : kBank;
  const auto raw_channels = channels<kBank>(bytes + wire::kBlockHeaderBytes);
  const AzimuthTable::Entry head = azimuths_[wire::u16(bytes + 2)];
  const float step_m = step_m_;
  Bank bank;
  // No branches here, and nothing the compiler may not compute for four lasers at once.
  for (std::size_t k = 0; k < kBank; ++k) {
    const std::size_t i = first_laser + k;
    const std::int32_t steps = raw_channels[k] & 0xFFFF;
    const auto echo = static_cast<float>(raw_channels[k] >> 16);
    const float cos_a = head.cos * lasers_.cos_b[i] + head.sin * lasers_.sin_b[i];
    const float sin_a = head.sin * lasers_.cos_b[i] - head.cos * lasers_.sin_b[i];
    const float raw = static_cast<float>(steps) * step_m;
    const float d = raw + lasers_.dist_m[i];
    const float flat_x = lasers_.cos_w[i] * sin_a, flat_y = lasers_.cos_w[i] * cos_a;
    const float side = d * flat_x - lasers_.horizontal_m[i] * cos_a;   // the manual's x
    const float ahead = d * flat_y + lasers_.horizontal_m[i] * sin_a;  // and y
    const float more_x = lasers_.near_x[i] * (kFarM - std::min(std::abs(side), kFarM));
    const float more_y = lasers_.near_y[i] * (kFarM - std::min(std::abs(ahead), kFarM));
    const float focus =
        lasers_.slope[i] * std::abs(lasers_.focal[i] - square(1.0F - raw / kFocalRangeM));
    const float intensity =
        std::min(std::max(echo + focus, lasers_.min_intensity[i]), lasers_.max_intensity[i]);
    bank.x_m[k] = ahead + more_y * flat_y;
    bank.y_m[k] = -(side + more_x * flat_x);
    bank.z_m[k] = (d + 0.5F * (more_x + more_y)) * lasers_.sin_w[i] + lasers_.vertical_m[i];
    bank.azimuth_rad[k] = head.ccw_rad + lasers_.b_rad[i];
    bank.ring_and_intensity[k] = lasers_.ring[i] | static_cast<std::int32_t>(intensity) << 8;
    bank.steps[k] = steps;
    bank.in_range[k] = static_cast<std::int32_t>(steps >= lasers_.min_steps[i]) &
                       static_cast<std::int32_t>(steps <= lasers_.max_steps[i]);
  }
  wrap_around(head.ccw_rad, lasers_.largest_b_rad, bank.azimuth_rad);
  return bank;
}

void Hdl64eDecoder::append(std::size_t column, std::int32_t t_ns, Returns& out) const {
  if (dual_) {
    append_dual(static_cast<int>(column), t_ns, out);
  } else {
    append_single(static_cast<int>(column), t_ns, out);
  }
}

// Upper and lower laser of one number fire together, so they alternate in the scan.
void Hdl64eDecoder::append_single(int pair, std::int32_t t_ns, Returns& out) const {
  const Bank upper = project(2 * pair), lower = project(2 * pair + 1);
  Kept<2 * kBank> kept(out);
  for (std::size_t k = 0; k < kBank; ++k) {
    const std::int32_t at_ns = t_ns + laser_ns_[k];
    kept.add(upper, k, at_ns, ReturnKind::strongest, upper.in_range[k]);
    kept.add(lower, k, at_ns, ReturnKind::strongest, lower.in_range[k]);
  }
}

// No manual page says which pair is the strongest and which the last; the order here is that of
// velodyne_decoder. Equal ones are one echo.
void Hdl64eDecoder::append_dual(int shot, std::int32_t t_ns, Returns& out) const {
  const std::array<Bank, 2> first{project(4 * shot), project(4 * shot + 1)};
  const std::array<Bank, 2> second{project(4 * shot + 2), project(4 * shot + 3)};
  Kept<4 * kBank> kept(out);
  for (std::size_t k = 0; k < kBank; ++k) {
    const std::int32_t at_ns = t_ns + laser_ns_[k];
    for (std::size_t bank = 0; bank < 2; ++bank) {
      const bool same = first[bank].steps[k] == second[bank].steps[k];
      const bool want_first = same || choice_ != ReturnChoice::last;
      const bool want_second = !same && choice_ != ReturnChoice::strongest;
      kept.add(first[bank], k, at_ns, same ? ReturnKind::both : ReturnKind::strongest,
               want_first ? first[bank].in_range[k] : 0);
      kept.add(second[bank], k, at_ns, ReturnKind::last,
               want_second ? second[bank].in_range[k] : 0);
    }
  }
}

}  // namespace lilo
