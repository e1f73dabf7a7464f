// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/status_bytes.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace lilo::sim {
namespace {

constexpr std::size_t kPerCycle = 7, kPerLaser = 28;

void push16(std::vector<std::uint8_t>& bytes, double steps) {
  const auto value = static_cast<std::int16_t>(std::floor(steps + 0.5));
  const auto bits = static_cast<std::uint16_t>(value);
  bytes.push_back(static_cast<std::uint8_t>(bits & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(bits >> 8U));
}

/// 21 bytes of one laser: id, nine signed words, two intensities.
std::vector<std::uint8_t> laser_record(std::size_t id, const LaserCorrection& c) {
  constexpr double kCentidegrees = 18000.0 / std::numbers::pi;
  std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(id)};
  push16(bytes, c.elevation_rad * kCentidegrees);
  push16(bytes, c.rotation_rad * kCentidegrees);
  push16(bytes, 1000.0 * c.distance_m);
  push16(bytes, 1000.0 * c.distance_x_m);
  push16(bytes, 1000.0 * c.distance_y_m);
  push16(bytes, 1000.0 * c.vertical_offset_m);
  push16(bytes, 1000.0 * c.horizontal_offset_m);
  push16(bytes, 1000.0 * c.focal_distance_m);
  push16(bytes, 10.0 * c.focal_slope);
  bytes.push_back(static_cast<std::uint8_t>(c.min_intensity));
  bytes.push_back(static_cast<std::uint8_t>(c.max_intensity));
  return bytes;
}

}  // namespace

std::uint16_t crc16(const std::vector<std::uint8_t>& bytes) {
  unsigned crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      crc = ((crc & 0x8000U) != 0 ? (crc << 1U) ^ 0x8005U : crc << 1U) & 0xFFFFU;
    }
  }
  return static_cast<std::uint16_t>(crc);
}

StatusBytes::StatusBytes(const SensorOptions& options, const std::vector<LaserCorrection>& lasers)
    : has_gps_(options.gps), is_s3_(options.sensor == Sensor::hdl64_s3) {
  add({'U', 'N', 'I', 'T', '#', 24, 24});
  set_type(2, 0xF7);
  set_type(1, 0xF6);
  add_table(lasers);
  add_settings(options);
  // The S3 ends with a checksum over all lasers' bytes 1 to 20, the S2 with the table's length.
  std::uint16_t check = 1820;
  if (is_s3_) {
    std::vector<std::uint8_t> covered;
    for (std::size_t laser = 0; laser < 64; ++laser) {
      for (std::size_t k = 1; k <= 20; ++k) {
        covered.push_back(table_[kPerCycle + laser * kPerLaser + k].value);
      }
    }
    check = crc16(covered);
  }
  table_[table_.size() - 2].value = static_cast<std::uint8_t>(check & 0xFFU);
  table_[table_.size() - 1].value = static_cast<std::uint8_t>(check >> 8U);
}

void StatusBytes::add(std::initializer_list<int> values) {
  for (const int value : values) {
    const auto slot = static_cast<std::uint8_t>('1' + table_.size() % kPerCycle);
    table_.push_back({slot, static_cast<std::uint8_t>(value)});
  }
}

void StatusBytes::set_type(std::size_t from_end, std::uint8_t type) {
  table_[table_.size() - from_end].type = type;
}

void StatusBytes::add_table(const std::vector<LaserCorrection>& lasers) {
  for (std::size_t id = 0; id < lasers.size(); ++id) {
    for (const std::uint8_t byte : laser_record(id, lasers[id])) add({byte});
    if (id + 1 == lasers.size()) break;        // the last laser has no reserved cycle
    const int warnings = has_gps_ ? 0x60 : 0;  // PPS and GPS are present
    add({is_s3_ ? warnings : 0, 0, 0, 0, 0, 0, 0});
    if (is_s3_) set_type(7, 'W');
  }
}

void StatusBytes::add_settings(const SensorOptions& options) {
  const int rpm = static_cast<int>(std::floor(options.rpm + 0.5)), fov_end = 36000, hours = 1480;
  const int returns = static_cast<int>(options.returns);  // 0 strongest, 1 last, 2 both
  add({24, 3, 11, 14, 25, 9, 38});                        // calibrated when, and at what humidity
  add({rpm & 0xFF, rpm >> 8, 0, 0, fov_end & 0xFF, fov_end >> 8, hours & 0xFF});
  constexpr std::array<std::uint8_t, 6> kTypes{0xFE, 0xFF, 0xFC, 0xFD, 0xFA, 0xFB};
  for (std::size_t k = 0; k < kTypes.size(); ++k) set_type(7 - k, kTypes[k]);
  add({hours >> 8, 192, 168, 1, 201, 255, 255});
  add({255, 255, returns, 0, 0xA8, 0, 0});
  set_type(5, 0xF9);
  set_type(3, 0xF8);
}

StatusBytes::Pair StatusBytes::at(std::uint64_t index, std::int64_t utc_s) const {
  const std::uint64_t slot = index % 16, cycle = index / 16 % 260;
  if (slot >= 9) return table_[cycle * kPerCycle + (slot - 9)];
  using namespace std::chrono;
  const sys_seconds time{seconds(utc_s)};
  const sys_days day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(time - day);
  const auto byte = [](auto value) { return static_cast<std::uint8_t>(value); };
  switch (slot) {
    case 0:
      return {'H', byte(clock.hours().count())};
    case 1:
      return {'M', byte(clock.minutes().count())};
    case 2:
      return {'S', byte(clock.seconds().count())};
    case 3:
      return {'D', byte(static_cast<unsigned>(date.day()))};
    case 4:
      return {'N', byte(static_cast<unsigned>(date.month()))};
    case 5:
      return {'Y', byte(static_cast<int>(date.year()) % 100)};
    case 6:
      return {'G', has_gps_ ? std::uint8_t{'A'} : std::uint8_t{0}};
    case 7:
      return {'T', 41};
    default:
      return {'V', 0x47};
  }
}

}  // namespace lilo::sim
