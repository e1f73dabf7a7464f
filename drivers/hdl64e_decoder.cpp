#include "drivers/hdl64e_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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
    lasers_[i] = {.cos_w = f(std::cos(c.vert_rad)),
                  .sin_w = f(std::sin(c.vert_rad)),
                  .cos_b = f(std::cos(c.rot_rad)),
                  .sin_b = f(std::sin(c.rot_rad)),
                  .b_rad = f(c.rot_rad),
                  .dist_m = f(c.dist_m),
                  .near_x = near(c.dist_x_m, kNearXM),
                  .near_y = near(c.dist_y_m, kNearYM),
                  .horizontal_m = f(c.horiz_offset_m),
                  .vertical_m = f(c.vert_offset_m),
                  .focal = square(1.0F - f(c.focal_distance_m) / kFocalRangeM),
                  .slope = 256.0F * f(c.focal_slope),
                  .min_intensity = f(std::clamp(c.min_intensity, 0, 255)),
                  .max_intensity = f(std::clamp(c.max_intensity, 0, 255)),
                  .min_steps = std::max(1, steps(min_range_m_)),
                  .max_steps = steps(max_range_m_),
                  .ring = static_cast<std::uint8_t>(ring)};
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

void Hdl64eDecoder::project(const std::byte* block, std::size_t first_laser, std::int32_t t_ns,
                            ReturnKind kind, Bank& bank) const {
  const AzimuthTable::Entry& head = azimuths_[wire::u16(block + 2)];
  const std::byte* channel = block + wire::kBlockHeaderBytes;
  for (std::size_t k = 0; k < kBank; ++k, channel += wire::kChannelBytes) {
    const Laser& laser = lasers_[first_laser + k];
    const float cos_a = head.cos * laser.cos_b + head.sin * laser.sin_b;
    const float sin_a = head.sin * laser.cos_b - head.cos * laser.sin_b;
    const int steps = wire::u16(channel);
    const float raw = static_cast<float>(steps) * step_m_;
    const float d = raw + laser.dist_m;
    const float side = d * laser.cos_w * sin_a - laser.horizontal_m * cos_a;   // the manual's x
    const float ahead = d * laser.cos_w * cos_a + laser.horizontal_m * sin_a;  // and y
    const float more_x = laser.near_x * (kFarM - std::min(std::abs(side), kFarM));
    const float more_y = laser.near_y * (kFarM - std::min(std::abs(ahead), kFarM));
    const float focus = laser.slope * std::abs(laser.focal - square(1.0F - raw / kFocalRangeM));
    const float intensity = std::clamp(static_cast<float>(wire::u8(channel + 2)) + focus,
                                       laser.min_intensity, laser.max_intensity);
    const float ccw = head.ccw_rad + laser.b_rad;
    bank.returns[k] = {.x_m = ahead + more_y * laser.cos_w * cos_a,
                       .y_m = -(side + more_x * laser.cos_w * sin_a),
                       .z_m = (d + 0.5F * (more_x + more_y)) * laser.sin_w + laser.vertical_m,
                       .azimuth_rad = wrap_rad(ccw),
                       .t_ns = t_ns + static_cast<std::int32_t>(k / 4) * table_->group_ns +
                               table_->laser_ns[k % 4],
                       .ring = laser.ring,
                       .intensity = static_cast<std::uint8_t>(intensity),
                       .kind = kind};
    bank.steps[k] = static_cast<std::uint16_t>(steps);
    bank.in_range[k] = steps >= laser.min_steps && steps <= laser.max_steps;
  }
}

void Hdl64eDecoder::append(std::size_t column, std::int32_t t_ns, std::vector<Return>& out) const {
  if (dual_) {
    append_dual(static_cast<int>(column), t_ns, out);
  } else {
    append_single(static_cast<int>(column), t_ns, out);
  }
}

// Upper and lower laser of one number fire together, so they alternate in the scan.
void Hdl64eDecoder::append_single(int pair, std::int32_t t_ns, std::vector<Return>& out) const {
  Bank upper, lower;
  project(wire::block(packet_, 2 * pair), 0, t_ns, ReturnKind::strongest, upper);
  project(wire::block(packet_, 2 * pair + 1), kBank, t_ns, ReturnKind::strongest, lower);
  std::array<Return, 2 * kBank> kept;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kBank; ++k) {
    kept[count] = upper.returns[k];
    count += upper.in_range[k] ? 1U : 0U;
    kept[count] = lower.returns[k];
    count += lower.in_range[k] ? 1U : 0U;
  }
  out.insert(out.end(), kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
}

// No manual page says which pair is the strongest and which the last; the order here is that of
// velodyne_decoder. Equal ones are one echo.
void Hdl64eDecoder::append_dual(int shot, std::int32_t t_ns, std::vector<Return>& out) const {
  std::array<Bank, 2> first, second;
  for (std::size_t bank = 0; bank < 2; ++bank) {
    const int block = 4 * shot + static_cast<int>(bank);
    project(wire::block(packet_, block), bank * kBank, t_ns, ReturnKind::strongest, first[bank]);
    project(wire::block(packet_, block + 2), bank * kBank, t_ns, ReturnKind::last, second[bank]);
  }
  std::array<Return, 4 * kBank> kept;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kBank; ++k) {
    for (std::size_t bank = 0; bank < 2; ++bank) {
      const bool same = first[bank].steps[k] == second[bank].steps[k];
      kept[count] = first[bank].returns[k];
      if (same) kept[count].kind = ReturnKind::both;
      const bool want_first = same || choice_ != ReturnChoice::last;
      count += want_first && first[bank].in_range[k] ? 1U : 0U;
      kept[count] = second[bank].returns[k];
      const bool want_second = !same && choice_ != ReturnChoice::strongest;
      count += want_second && second[bank].in_range[k] ? 1U : 0U;
    }
  }
  out.insert(out.end(), kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace lilo
