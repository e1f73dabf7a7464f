// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/sensor_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr double kPeriodTolerance = 0.04;

/// Lasers in groups that fire together, `step_ns` from group to group; one step of `pause_after`
/// groups is left out.
constexpr FiringTimes in_groups(std::int32_t cycle_ns, int lasers, int at_a_time,
                                std::int32_t step_ns, int pause_after = kMaxRings) {
  FiringTimes times{.cycle_ns = cycle_ns};
  for (int i = 0; i < lasers; ++i) {
    const int group = i / at_a_time;
    times.laser_ns[static_cast<std::size_t>(i)] = (group + group / pause_after) * step_ns;
  }
  return times;
}

/// HDL-64E: four shots of uneven distance to a group, eight groups a block.
constexpr FiringTimes hdl64e(std::int32_t cycle_ns, std::int32_t group_ns,
                             const std::array<std::int32_t, 4>& shot_ns) {
  FiringTimes times{.cycle_ns = cycle_ns};
  for (std::size_t i = 0; i < 32; ++i)
    times.laser_ns[i] = static_cast<std::int32_t>(i / 4) * group_ns + shot_ns[i % 4];
  return times;
}

// --- VLP-16, Puck LITE, Puck Hi-Res. VLP-16 manual 63-9243 rev. D: sixteen firings 2.304 us apart
// and 18.43 us of recharge, the stamp that of the first (9.4 "Discreet Point Timing Calculation",
// page 62); bytes 37 to 39 and 22, 24 (9.3.1.7 "Factory Bytes", page 56); elevations and vertical
// corrections (table in chapter 9; 11.2 mm at 15 degrees: 41.91 mm tan w). Those of the Hi-Res are
// its own manual's.
constexpr std::array<FiringTimes, 1> kVlp16Times{in_groups(55'296, 16, 1, 2'304)};
constexpr std::array<double, 16> kVlp16Deg{-15, 1, -13, 3,  -11, 5,  -9, 7,
                                           -7,  9, -5,  11, -3,  13, -1, 15};
constexpr std::array<double, 16> kHiResDeg{-10.00, 0.67, -8.67, 2.00, -7.33, 3.33, -6.00, 4.67,
                                           -4.67,  6.00, -3.33, 7.33, -2.00, 8.67, -0.67, 10.00};
constexpr double kVlp16Origin_m = 0.04191;

// --- VLP-32C. Manual 63-9325 rev. C: two lasers at a time, 2.304 us apart, 55.296 us a cycle (9.4,
// page 62); elevations and azimuth offsets by laser (table 9-6, pages 66 and 67); distances in 4
// mm. The real capture's points agree. The origin's 42.4 mm are in none of them: without it the
// floor of the real capture lies 24 mm lower below the sensor than 2 m away, with it 11 mm.
constexpr std::array<FiringTimes, 1> kVlp32cTimes{in_groups(55'296, 32, 2, 2'304)};
constexpr std::array<double, 32> kVlp32cDeg{
    -25,    -1,     -1.667, -15.639, -11.31, 0,      -0.667, -8.843, -7.254, 0.333,  -0.333,
    -6.148, -5.333, 1.333,  0.667,   -4,     -4.667, 1.667,  1,      -3.667, -3.333, 3.333,
    2.333,  -2.667, -3,     7,       4.667,  -2.333, -2,     15,     10.333, -1.333};
constexpr std::array<double, 32> kVlp32cAzimuthDeg{
    1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
    1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4};

// --- HDL-32E. Manual 63-9113: elevations (table in "Laser Firing Sequence", page 10), all on the
// axis. Appendix E "Ethernet Transit Timing Table", page 24: a laser fires -542.592 us + 46.08 us
// times the block + 1.152 us times the laser after the stamp, which is written at the end of the
// packet: 10.368 us before its twelve cycles are over. What that is in dual return mode, which the
// manual does not know yet, is taken to be the same before the end of its six.
constexpr std::array<FiringTimes, 1> kHdl32eTimes{in_groups(46'080, 32, 1, 1'152)};
constexpr std::array<double, 32> kHdl32eDeg{
    -30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
    -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
    -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67};

// --- VLS-128 (Alpha Prime). Manual 63-9483 rev. A: eight lasers at a time, 2.665 us apart, a pause
// of 2.665 us after eight of the sixteen groups and one of 7.995 us at the end, 53.3 us a cycle "on
// average"; the stamp is the fourth group's, so 8.7 us are to be taken off (all page 61); distances
// in 4 mm (9.3.1.3, page 54). Page 57, as tier4/nebula cites it: dual return has eight blocks and
// four without data. The real capture's cycle is 55.28 us, wavering by 0.7 us from packet to
// packet, and later firmware is said to take 57.8 us: it is measured. Calibration files may say 7
// mm a step (nebula's does); the real capture's reference cloud has 4. Angles are those of nebula's
// file. The product byte is the real capture's; the table in the VLP-16's manual says 0x63.
constexpr std::array<FiringTimes, 1> kVls128Times{in_groups(53'300, 128, 8, 2'665, 8)};
constexpr std::array<double, 128> kVls128Deg{
    -11.742, -1.99,   3.4,    -5.29,  -0.78, 4.61,    -4.08,   1.31,     //
    -6.5,    -1.11,   4.28,   -4.41,  0.1,   6.48,    -3.2,    2.19,     //
    -3.86,   1.53,    -9.244, -1.77,  2.74,  -5.95,   -0.56,   4.83,     //
    -2.98,   2.41,    -6.28,  -0.89,  3.62,  -5.07,   0.32,    7.58,     //
    -0.34,   5.18,    -3.64,  1.75,   -25,   -2.43,   2.96,    -5.73,    //
    0.54,    9.7,     -2.76,  2.63,   -7.65, -1.55,   3.84,    -4.85,    //
    3.18,    -5.51,   -0.12,  5.73,   -4.3,  1.09,    -16.042, -2.21,    //
    4.06,    -4.63,   0.76,   15,     -3.42, 1.97,    -6.85,   -1.33,    //
    -5.62,   -0.23,   5.43,   -3.53,  0.98,  -19.582, -2.32,   3.07,     //
    -4.74,   0.65,    11.75,  -2.65,  1.86,  -7.15,   -1.44,   3.95,     //
    -2.1,    3.29,    -5.4,   -0.01,  4.5,   -4.19,   1.2,     -13.565,  //
    -1.22,   4.17,    -4.52,  0.87,   6.08,  -3.31,   2.08,    -6.65,    //
    1.42,    -10.346, -1.88,  3.51,   -6.06, -0.67,   4.72,    -3.97,    //
    2.3,     -6.39,   -1,     4.39,   -5.18, 0.21,    6.98,    -3.09,    //
    4.98,    -3.75,   1.64,   -8.352, -2.54, 2.85,    -5.84,   -0.45,    //
    8.43,    -2.87,   2.52,   -6.17,  -1.66, 3.73,    -4.96,   0.43};
constexpr std::array<double, 8> kVls128AzimuthDeg{6.354,  4.548,  2.732,  0.911,
                                                  -0.911, -2.732, -4.548, -6.354};

// --- HDL-64E S2 and S3. "Ethernet Transmit Timing Table", appendix G of the manual of the S2 (48
// us a shot) and of the S3, 63-HDL64ES3 rev. K (57.6 us), as velodyne_decoder cites them; which one
// holds tells the packets' period. VeloView counts the stamp as the end of the packet, others as
// its beginning; no manual page says. It shifts all times alike by one packet. Each unit has its
// own angles.
constexpr std::array<FiringTimes, 2> kHdl64eTimes{hdl64e(48'000, 6'000, {0, 1'260, 2'460, 3'660}),
                                                  hdl64e(57'600, 7'200, {0, 1'300, 2'500, 3'700})};

constexpr SensorTable kVlp16{.model = SensorModel::vlp16,
                             .name = "VLP-16",
                             .product = 0x22,
                             .lasers = 16,
                             .cycles_per_block = 2,
                             .times = kVlp16Times,
                             .elevation_deg = kVlp16Deg,
                             .origin_radius_m = kVlp16Origin_m};

constexpr SensorTable kHiRes{.model = SensorModel::vlp16,
                             .name = "Puck Hi-Res",
                             .product = 0x24,
                             .lasers = 16,
                             .cycles_per_block = 2,
                             .times = kVlp16Times,
                             .elevation_deg = kHiResDeg,
                             .origin_radius_m = kVlp16Origin_m};

constexpr SensorTable kVlp32c{.model = SensorModel::vlp32c,
                              .name = "VLP-32C",
                              .product = 0x28,
                              .lasers = 32,
                              .distance_step_m = 0.004,
                              .max_range_m = 200.0,
                              .times = kVlp32cTimes,
                              .elevation_deg = kVlp32cDeg,
                              .azimuth_deg = kVlp32cAzimuthDeg,
                              .origin_radius_m = 0.0424};

constexpr SensorTable kHdl32e{.model = SensorModel::hdl32e,
                              .name = "HDL-32E",
                              .product = 0x21,
                              .lasers = 32,
                              .times = kHdl32eTimes,
                              .first_firing_ns = 10'368,
                              .stamp_is_packet_end = true,
                              .elevation_deg = kHdl32eDeg};

constexpr SensorTable kVls128{
    .model = SensorModel::vls128,
    .name = "VLS-128",
    .product = 0xA1,
    .lasers = 128,
    .banks = 4,
    .bank_flags = {wire::kUpperFlag, wire::kLowerFlag, wire::kThirdFlag, wire::kFourthFlag},
    .has_confidence = true,
    .distance_step_m = 0.004,
    .max_range_m = 245.0,
    .times = kVls128Times,
    .cycle_varies = true,
    .first_firing_ns = -8'700,
    .elevation_deg = kVls128Deg,
    .azimuth_deg = kVls128AzimuthDeg,
    .origin_radius_m = 0.05863};

constexpr SensorTable kHdl64e{.model = SensorModel::hdl64e,
                              .name = "HDL-64E",
                              .lasers = 64,
                              .banks = 2,
                              .bank_flags = {wire::kUpperFlag, wire::kLowerFlag},
                              .banks_fire_together = true,
                              .echoes = EchoOrder::strongest_then_last,
                              .max_range_m = 120.0,
                              .range_noise_m = 0.018,
                              .times = kHdl64eTimes,
                              .turns_within_block = false,
                              .stamp_is_packet_end = true};

constexpr std::array kAll{&kVlp16, &kHiRes, &kVlp32c, &kHdl32e, &kVls128, &kHdl64e};

constexpr std::array<const SensorTable*, 256> by_product() {
  std::array<const SensorTable*, 256> tables{};
  for (const SensorTable* table : kAll)
    if (table->product != 0) tables[table->product] = table;
  return tables;
}
constexpr auto kByProduct = by_product();  // asked for every packet

}  // namespace

std::span<const SensorTable* const> sensor_tables() { return kAll; }

const SensorTable* find_sensor(SensorModel model) {
  const auto* const found = std::find_if(
      kAll.begin(), kAll.end(), [&](const SensorTable* table) { return table->model == model; });
  return found == kAll.end() ? nullptr : *found;
}

const SensorTable* find_product(std::uint8_t product) { return kByProduct[product]; }

Calibration built_in_calibration(const SensorTable& table) {
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  Calibration calibration{.lasers = {}, .distance_step_m = table.distance_step_m};
  calibration.lasers.resize(table.elevation_deg.size());
  for (std::size_t i = 0; i < calibration.lasers.size(); ++i) {
    LaserCorrection& laser = calibration.lasers[i];
    laser.vert_rad = table.elevation_deg[i] * std::numbers::pi / 180.0;
    if (!table.azimuth_deg.empty())
      laser.rot_rad = -table.azimuth_deg[i % table.azimuth_deg.size()] * kRadPerDeg;
    laser.vert_offset_m = table.origin_radius_m * std::tan(-laser.vert_rad);
  }
  return calibration;
}

const FiringTimes* find_firing_times(const SensorTable& table, double packet_period_ns, bool dual) {
  const double cycle_ns = packet_period_ns / table.cycles_per_packet(dual);
  for (const FiringTimes& times : table.times)
    if (std::abs(cycle_ns / times.cycle_ns - 1.0) < kPeriodTolerance) return &times;
  return nullptr;
}

}  // namespace lilo
