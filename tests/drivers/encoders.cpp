// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/packets.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace lilo::test {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr std::int64_t kMicrosPerHour = 3'600'000'000;

struct Point {
  double x, y, z;
};
using PointAt = std::function<Point(double range_m)>;
using Beyond = bool (*)(double, double, double);

// The range at which a beam reaches a surface, by bisection: needs no formula of the beam's.
int steps_to(const PointAt& point_at, Beyond beyond) {
  double near = 0.0, far = 30.0;
  for (int i = 0; i < 34; ++i) {
    const double middle = 0.5 * (near + far);
    const Point p = point_at(middle);
    (beyond(p.x, p.y, p.z) ? far : near) = middle;
  }
  return static_cast<int>(std::lround(near / 0.002));
}

int ticks(double deg) {
  const double wrapped = deg - 360.0 * std::floor(deg / 360.0);
  return static_cast<int>(std::lround(wrapped * 100.0)) % 36000;
}

double azimuth_deg(const DriveOptions& o, double t_us) {
  return o.start_azimuth_deg + (o.counter_clockwise ? -1.0 : 1.0) * o.rpm * 6.0 * t_us * 1e-6;
}

std::uint32_t past_hour_us(const DriveOptions& o, double t_us) {
  const auto us = static_cast<std::int64_t>(o.start_past_hour_s * 1e6 + t_us);
  return static_cast<std::uint32_t>(us % kMicrosPerHour);
}

TimedPacket stamped(PacketBytes& bytes, const DriveOptions& o, double stamp_us, double sent_us) {
  bytes.stamp(past_hour_us(o, stamp_us));
  return {.bytes = bytes.take(),
          .received_ns = o.start_received_ns + static_cast<std::int64_t>(sent_us * 1e3)};
}

// VLP-16: x forward is azimuth 0, y is to the left, azimuth runs clockwise.
PointAt vlp16_beam(double azimuth_rad, double elevation_rad) {
  const double origin_m = 0.04191 * std::tan(-elevation_rad);
  const double ahead = std::cos(elevation_rad) * std::cos(azimuth_rad);
  const double left = -std::cos(elevation_rad) * std::sin(azimuth_rad);
  const double up = std::sin(elevation_rad);
  return [=](double r) { return Point{r * ahead, r * left, r * up + origin_m}; };
}

constexpr std::array<double, 16> kVlp16Deg = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                              -7,  9, -5,  11, -3,  13, -1, 15};
constexpr std::array<double, 16> kHiResDeg = {-10,   0.67, -8.67, 2,    -7.33, 3.33, -6,    4.67,
                                              -4.67, 6,    -3.33, 7.33, -2,    8.67, -0.67, 10};

// Manual, appendix: the four steps of the two-point calibration, in its own axes (x right, y
// ahead).
PointAt hdl64e_beam(double azimuth_rad, const LaserCorrection& c) {
  const double angle = azimuth_rad - c.rot_rad;
  const double sin_a = std::sin(angle), cos_a = std::cos(angle);
  const double sin_w = std::sin(c.vert_rad), cos_w = std::cos(c.vert_rad);
  return [=](double measured_m) {
    const double d = measured_m + c.dist_m;
    double extra_x = 0.0, extra_y = 0.0;
    if (c.two_point) {
      const double xx = std::abs(d * cos_w * sin_a - c.horiz_offset_m * cos_a);
      const double yy = std::abs(d * cos_w * cos_a + c.horiz_offset_m * sin_a);
      if (xx < 25.04)
        extra_x = (c.dist_m - c.dist_x_m) * (xx - 2.4) / (25.04 - 2.4) + c.dist_x_m - c.dist_m;
      if (yy < 25.04)
        extra_y = (c.dist_m - c.dist_y_m) * (yy - 1.93) / (25.04 - 1.93) + c.dist_y_m - c.dist_m;
    }
    const double x = (d + extra_x) * cos_w * sin_a - c.horiz_offset_m * cos_a;
    const double y = (d + extra_y) * cos_w * cos_a + c.horiz_offset_m * sin_a;
    const double z = (d + 0.5 * (extra_x + extra_y)) * sin_w + c.vert_offset_m;
    return Point{y, -x, z};
  };
}

void put(std::vector<std::uint8_t>& out, double value, double unit) {
  const auto i = static_cast<int>(std::lround(value / unit));
  out.push_back(static_cast<std::uint8_t>(i & 0xFF));
  out.push_back(static_cast<std::uint8_t>((i >> 8) & 0xFF));
}

// Polynomial division, bit by bit, as the S3 manual describes its CRC-16.
std::uint16_t checksum(const std::vector<std::uint8_t>& bytes) {
  unsigned remainder = 0;
  for (const std::uint8_t byte : bytes)
    for (int bit = 7; bit >= 0; --bit) {
      const bool out = ((remainder >> 15U) & 1U) != ((static_cast<unsigned>(byte) >> bit) & 1U);
      remainder = ((remainder << 1U) & 0xFFFFU) ^ (out ? 0x8005U : 0U);
    }
  return static_cast<std::uint16_t>(remainder);
}

// The 1820 bytes of one lap.
std::vector<std::uint8_t> table_bytes(const HdlOptions& o) {
  constexpr double kCentiDeg = kRadPerDeg / 100.0, kMm = 0.001;
  std::vector<std::uint8_t> bytes = {'U', 'N', 'I', 'T', '#', 24, 24};
  std::vector<std::uint8_t> summed;
  for (std::size_t id = 0; id < 64; ++id) {
    const LaserCorrection& c = o.calibration.lasers[id];
    std::vector<std::uint8_t> record;
    put(record, c.vert_rad, kCentiDeg);
    put(record, c.rot_rad, kCentiDeg);
    for (const double length :
         {c.dist_m, c.dist_x_m, c.dist_y_m, c.vert_offset_m, c.horiz_offset_m, c.focal_distance_m})
      put(record, length, kMm);
    put(record, c.focal_slope, 0.1);
    record.push_back(static_cast<std::uint8_t>(c.min_intensity));
    record.push_back(static_cast<std::uint8_t>(c.max_intensity));
    summed.insert(summed.end(), record.begin(), record.end());
    bytes.push_back(static_cast<std::uint8_t>(id));
    bytes.insert(bytes.end(), record.begin(), record.end());
    if (id < 63) bytes.insert(bytes.end(), 7, 0);  // the fourth cycle is reserved
  }
  const std::vector<std::uint8_t> rest = {16, 11,  15,   12,   47,  47, 25,  0x58, 2,
                                          0,  0,   0xA0, 0x8C, 10,  0,  192, 168,  3,
                                          43, 192, 168,  3,    255, 0,  0,   0xA0};
  // The 64th laser has its three cycles and no reserved one.
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  const std::uint16_t end = o.s3 ? checksum(summed) : std::uint16_t{1820};
  put(bytes, o.break_checksum ? end ^ 1 : end, 1.0);
  return bytes;
}

// Type and value of one packet's status, by its place in the lap of 4160.
std::array<std::uint8_t, 2> status_at(const HdlOptions& o, const std::vector<std::uint8_t>& table,
                                      int place, std::uint32_t us) {
  const int cycle = (place / 16) % 260, slot = place % 16;
  const auto byte = [](auto v) { return static_cast<std::uint8_t>(v); };
  const std::int64_t utc_s = o.drive.start_received_ns / 1'000'000'000;
  switch (slot) {
    case 0:
      return {'H', byte(utc_s / 3600 % 24)};
    case 1:
      return {'M', byte(us / 60'000'000)};
    case 2:
      return {'S', byte(us / 1'000'000 % 60)};
    case 3:
      return {'D', 14};
    case 4:
      return {'N', 5};
    case 5:
      return {'Y', 24};
    case 6:
      return {'G', byte(o.gps ? 'A' : 0)};
    case 7:
      return {'T', 40};
    case 8:
      return {'V', 0x47};
    default:
      break;
  }
  const auto at = static_cast<std::size_t>(cycle) * 7 + static_cast<std::size_t>(slot - 9);
  const bool warning = o.s3 && slot == 9 && cycle > 0 && cycle % 4 == 0 && cycle < 256;
  const std::uint8_t type = warning ? 'W' : byte('1' + slot - 9);
  return {type, table[at]};
}

}  // namespace

std::vector<TimedPacket> vlp16_packets(int count, const DriveOptions& o, std::uint8_t product) {
  const auto& elevation_deg = product == 0x24 ? kHiResDeg : kVlp16Deg;
  const bool dual = o.mode == Mode::dual;
  const int stride = dual ? 2 : 1;
  std::vector<TimedPacket> packets;
  for (int n = 0; n < count; ++n) {
    PacketBytes bytes;
    const double start_us = n * 55.296 * 24 / stride;
    for (int b = 0; b < 12; b += stride) {
      const int shot = b / stride;
      const double block_us = start_us + 110.592 * shot;
      for (int pair = 0; pair < stride; ++pair)
        bytes.block(b + pair, 0xEEFF, ticks(azimuth_deg(o, block_us)));
      for (int c = 0; c < 32; ++c) {
        const int sequence = c / 16;
        const double t_us = block_us + 55.296 * sequence + 2.304 * (c % 16);
        const auto beam = vlp16_beam(azimuth_deg(o, t_us) * kRadPerDeg,
                                     elevation_deg[static_cast<std::size_t>(c % 16)] * kRadPerDeg);
        bytes.channel(b, c, steps_to(beam, Room::beyond), 10);
        if (dual) bytes.channel(b + 1, c, steps_to(beam, Room::beyond_glass), 90);
      }
    }
    const std::uint8_t mode = dual ? 0x39 : (o.mode == Mode::last ? 0x38 : 0x37);
    bytes.tail(mode, product);
    packets.push_back(stamped(bytes, o, start_us, start_us + 55.296 * 24 / stride));
  }
  return packets;
}

std::vector<TimedPacket> hdl64e_packets(int count, const HdlOptions& o) {
  const bool dual = o.drive.mode == Mode::dual;
  const int shots = dual ? 3 : 6;
  const double shot_us = o.s3 ? 57.6 : 48.0;
  const auto table = table_bytes(o);
  std::vector<TimedPacket> packets;
  for (int n = 0; n < count; ++n) {
    PacketBytes bytes;
    const double start_us = n * shot_us * shots;
    for (int b = 0; b < 12; ++b) {
      const int shot = b * shots / 12;
      const int azimuth = ticks(azimuth_deg(o.drive, start_us + shot_us * shot));
      bytes.block(b, b % 2 == 0 ? 0xEEFF : 0xDDFF, azimuth);
      const bool second_echo = dual && b % 4 >= 2;
      for (int c = 0; c < 32 && !o.without_returns; ++c) {
        const std::size_t laser = (b % 2 == 0 ? 0U : 32U) + static_cast<std::size_t>(c);
        const auto beam = hdl64e_beam(azimuth * 0.01 * kRadPerDeg, o.calibration.lasers[laser]);
        bytes.channel(b, c,
                      steps_to(beam, dual && !second_echo ? Room::beyond_glass : Room::beyond), 50);
      }
    }
    const double end_us = start_us + shot_us * shots;
    const auto status = status_at(o, table, n + o.start_in_cycle, past_hour_us(o.drive, end_us));
    bytes.tail(status[0], status[1]);
    packets.push_back(stamped(bytes, o.drive, end_us, end_us));
  }
  return packets;
}

Calibration sample_calibration(bool two_point) {
  Calibration calibration;
  calibration.lasers.resize(64);
  for (int i = 0; i < 64; ++i) {
    LaserCorrection& c = calibration.lasers[static_cast<std::size_t>(i)];
    // Upper block from +2 degrees down, lower block from -8.85 down, both out of order by pairs.
    const int order = i % 2 == 0 ? i + 1 : i - 1;
    const int vert = i < 32 ? 200 - 34 * order : -885 - 50 * (order - 32);
    c.vert_rad = vert / 100.0 * kRadPerDeg;
    c.rot_rad = (-800 + (i * 137) % 1600) / 100.0 * kRadPerDeg;
    c.dist_m = (1200 + (i * 31) % 350) / 1000.0;
    c.dist_x_m = two_point ? c.dist_m + (i % 7 - 3) * 0.01 : 0.0;
    c.dist_y_m = two_point ? c.dist_m + (i % 5 - 2) * 0.012 : 0.0;
    c.two_point = two_point;
    c.vert_offset_m = (i < 32 ? 200 : 120) / 1000.0 + i * 0.001;
    c.horiz_offset_m = i % 2 == 0 ? 0.026 : -0.026;
    c.focal_distance_m = 5.0 + (i % 10);
    c.focal_slope = 0.8 + 0.1 * (i % 8);
    c.min_intensity = 10 + i % 3;
    c.max_intensity = 250;
  }
  return calibration;
}

}  // namespace lilo::test
