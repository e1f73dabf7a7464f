// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/hdl64e_status.hpp"

#include "drivers/gprmc.hpp"

#include <algorithm>
#include <numbers>
#include <string_view>

namespace lilo {
namespace {

constexpr std::string_view kTimeTypes = "HMSDNYGTV";
constexpr std::string_view kMarker = "UNIT#";
constexpr std::size_t kHeaderBytes = 7, kRecordBytes = 28, kLaserBytes = 21, kLasers = 64;
constexpr std::uint16_t kS2Length = Hdl64eStatus::kTableBytes;

using Record = const std::uint8_t*;

std::int16_t i16(Record r) { return static_cast<std::int16_t>(r[0] | (r[1] << 8)); }

// id, then nine i16, then the limits of the intensity: lengths in mm, angles in 0.01 degree.
LaserCorrection decode_laser(Record r) {
  constexpr double kRadPerCentiDeg = std::numbers::pi / 18000.0, kMetresPerMm = 0.001;
  LaserCorrection laser;
  laser.vert_rad = i16(r + 1) * kRadPerCentiDeg;
  laser.rot_rad = i16(r + 3) * kRadPerCentiDeg;
  laser.dist_m = i16(r + 5) * kMetresPerMm;
  laser.dist_x_m = i16(r + 7) * kMetresPerMm;
  laser.dist_y_m = i16(r + 9) * kMetresPerMm;
  laser.two_point = laser.dist_x_m != 0.0 || laser.dist_y_m != 0.0;
  laser.vert_offset_m = i16(r + 11) * kMetresPerMm;
  laser.horiz_offset_m = i16(r + 13) * kMetresPerMm;
  laser.focal_distance_m = i16(r + 15) * kMetresPerMm;
  laser.focal_slope = i16(r + 17) * 0.1;
  laser.min_intensity = r[19];
  laser.max_intensity = r[20];
  return laser;
}

}  // namespace

std::uint16_t crc16(const std::uint8_t* bytes, std::size_t count, std::uint16_t crc) {
  constexpr unsigned kPolynomial = 0x8005;
  unsigned reg = crc;
  for (std::size_t i = 0; i < count; ++i) {
    reg ^= static_cast<unsigned>(bytes[i]) << 8U;
    for (int bit = 0; bit < 8; ++bit)
      reg = (reg & 0x8000U) != 0 ? (reg << 1U) ^ kPolynomial : reg << 1U;
    reg &= 0xFFFFU;
  }
  return static_cast<std::uint16_t>(reg);
}

void Hdl64eStatus::restart() { *this = Hdl64eStatus(); }

double Hdl64eStatus::progress() const {
  return std::min(1.0, static_cast<double>(seen_count_) / static_cast<double>(kTableBytes));
}

Hdl64eStatus::Table Hdl64eStatus::see(std::uint8_t type, std::uint8_t value, std::uint32_t lost,
                                      bool has_checksum) {
  position_ = started_ ? (position_ + 1 + lost % kLap) % kLap : 0;
  started_ = true;
  if (lost > 0) time_count_ = 0;
  note_time(type, value);
  if (!phase_holds(type)) {
    restart();
    return Table::incomplete;
  }
  if (!phase_ || (position_ + kCycle - *phase_) % kCycle < kTimeSlots) return Table::incomplete;
  note_byte(value);
  if (type == '5') find_marker();
  if (!origin_ || seen_count_ < kTableBytes) return Table::incomplete;
  return judge(has_checksum);
}

// The nine first types of a cycle occur nowhere else: they say where it begins.
bool Hdl64eStatus::phase_holds(std::uint8_t type) {
  const std::size_t slot = kTimeTypes.find(static_cast<char>(type));
  if (slot == std::string_view::npos) return true;
  const std::size_t phase = (position_ + kCycle - slot) % kCycle;
  if (!phase_) phase_ = phase;
  return *phase_ == phase;
}

void Hdl64eStatus::note_time(std::uint8_t type, std::uint8_t value) {
  if (type == 'T') temperature_c_ = value;
  if (type == 'V') firmware_ = value;
  const std::size_t slot = kTimeTypes.find(static_cast<char>(type));
  if (slot >= time_.size()) return;
  time_[slot] = value;
  time_count_ = slot == 0 ? 1 : (slot == time_count_ ? time_count_ + 1 : 0);
  if (time_count_ < time_.size()) return;
  time_count_ = 0;
  const auto [h, m, s, d, n, y, g] = time_;
  const bool date = d >= 1 && d <= 31 && n >= 1 && n <= 12 && y <= 99;
  if (g == 'A' && h < 24 && m < 60 && s <= 60 && date)
    gps_utc_ns_ = utc_seconds(2000 + y, n, d, h, m, s) * 1'000'000'000;
}

std::optional<std::int64_t> Hdl64eStatus::take_gps_utc_ns() {
  const auto utc_ns = gps_utc_ns_;
  gps_utc_ns_.reset();
  return utc_ns;
}

// A byte that differs from the last lap's: the table has changed, or this byte or the one before is
// wrong. Which of it all holds is not known, so the lap starts again.
void Hdl64eStatus::note_byte(std::uint8_t value) {
  const bool known = seen_[position_], same = values_[position_] == value;
  if (known && !same) {
    judged_ = false;
    seen_.reset();
    seen_twice_.reset();
    seen_count_ = seen_twice_count_ = 0;
  }
  if (!seen_[position_]) ++seen_count_;
  if (known && same && !seen_twice_[position_]) ++seen_twice_count_;
  seen_twice_[position_] = known && same;
  seen_.set(position_);
  values_[position_] = value;
}

void Hdl64eStatus::find_marker() {
  constexpr std::size_t kLength = kMarker.size();
  for (std::size_t i = 0; i < kLength; ++i) {
    const std::size_t at = (position_ + kLap - (kLength - 1) + i) % kLap;
    if (!seen_[at] || values_[at] != static_cast<std::uint8_t>(kMarker[i])) return;
  }
  origin_ = (position_ + kLap - (kLength - 1) - kTimeSlots) % kLap;
}

std::array<std::uint8_t, Hdl64eStatus::kTableBytes> Hdl64eStatus::table_bytes() const {
  std::array<std::uint8_t, kTableBytes> bytes{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < kLap; ++i)
    if (i % kCycle >= kTimeSlots) bytes[count++] = values_[(*origin_ + i) % kLap];
  return bytes;
}

Hdl64eStatus::Table Hdl64eStatus::judge(bool has_checksum) {
  const bool whole_twice = seen_twice_count_ >= kTableBytes;
  if (judged_ && !whole_twice) return Table::incomplete;
  const auto bytes = table_bytes();
  std::uint16_t crc = 0;
  bool ids_hold = true;
  calibration_.lasers.resize(kLasers);
  for (std::size_t i = 0; i < kLasers; ++i) {
    const Record record = bytes.data() + kHeaderBytes + i * kRecordBytes;
    crc = crc16(record + 1, kLaserBytes - 1, crc);
    ids_hold = ids_hold && record[0] == i;
    calibration_.lasers[i] = decode_laser(record);
  }
  const auto stated = static_cast<std::uint16_t>(i16(bytes.data() + kTableBytes - 2));
  judged_ = true;
  if (whole_twice) {
    seen_twice_.reset();
    seen_twice_count_ = 0;
  }
  if (!ids_hold || !implausible(calibration_).empty()) return Table::refused;
  if (stated == crc) return Table::checked;
  if (has_checksum) return Table::refused;
  if (stated == kS2Length) return Table::unchecked;
  return whole_twice ? Table::repeated : Table::incomplete;
}

}  // namespace lilo
