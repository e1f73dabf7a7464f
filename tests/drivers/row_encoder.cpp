// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/packets.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace lilo::test {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// What the manuals say of layout and time.
struct Row {
  int banks, lasers_at_a_time;
  double cycle_us, step_us, stamp_us;  // the stamp after the first firing
  double distance_step_m, origin_m;
  int product;
};

Row row_of(const RowOptions& o) {
  if (o.model == SensorModel::vlp32c) return {1, 2, 55.296, 2.304, 0.0, 0.004, 0.0424, 0x28};
  // Manual, appendix E: the stamp is 542.592 us after the first of twelve firings, 10.368 us before
  // the end.
  const double hdl32e_stamp_us = (o.drive.mode == Mode::dual ? 6 : 12) * 46.08 - 10.368;
  if (o.model == SensorModel::hdl32e)
    return {1, 1, 46.08, 1.152, hdl32e_stamp_us, 0.002, 0.0, 0x21};
  return {4, 8, o.vls128_cycle_us, 2.665, 8.7, 0.004, 0.05863, 0xA1};
}

double firing_us(const Row& row, int laser) {
  const int group = laser / row.lasers_at_a_time;
  const bool after_pause = row.banks == 4 && group >= 8;  // VLS-128: one step after eight groups
  return row.step_us * (group + (after_pause ? 1 : 0));
}

int echoes_stride(const RowOptions& o) {
  if (o.drive.mode != Mode::dual) return 1;
  return o.dual_byte == 0x3B ? 3 : 2;
}

// By bisection: needs no formula of the surfaces.
int steps_to(const RowOptions& o, const Row& row, int laser, double azimuth_rad, bool glass) {
  const SensorTable& table = *find_sensor(o.model);
  const double w = table.elevation_deg[static_cast<std::size_t>(laser)] * kRadPerDeg;
  const double ahead = std::cos(w) * std::cos(azimuth_rad);
  const double left = -std::cos(w) * std::sin(azimuth_rad);
  const double up = std::sin(w), origin_m = -row.origin_m * std::tan(w);
  double near = 0.0, far = 30.0;
  for (int i = 0; i < 24; ++i) {
    const double r = 0.5 * (near + far);
    const double x = r * ahead, y = r * left, z = r * up + origin_m;
    ((glass ? Room::beyond_glass(x, y, z) : Room::beyond(x, y, z)) ? far : near) = r;
  }
  return static_cast<int>(std::lround(near / row.distance_step_m));
}

double turned_deg(const RowOptions& o, double t_us) {
  const double way = o.drive.counter_clockwise ? -1.0 : 1.0;
  return o.drive.start_azimuth_deg + way * o.drive.rpm * 6.0 * t_us * 1e-6;
}

int ticks(double deg) {
  return static_cast<int>(std::lround((deg - 360.0 * std::floor(deg / 360.0)) * 100.0)) % 36000;
}

void fill(PacketBytes& bytes, const RowOptions& o, const Row& row, int first, double start_us) {
  constexpr std::array<int, 4> kFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
  const auto offsets = find_sensor(o.model)->azimuth_deg;
  const int stride = echoes_stride(o);
  for (int bank = 0; bank < row.banks; ++bank) {
    for (int echo = 0; echo < stride; ++echo) {
      const int block = first + bank * stride + echo;
      bytes.block(block, static_cast<std::uint16_t>(kFlags[static_cast<std::size_t>(bank)]),
                  ticks(turned_deg(o, start_us)));
      for (int c = 0; c < 32 && echo < 2; ++c) {
        const int laser = 32 * bank + c;
        const double offset_deg =
            offsets.empty() ? 0.0 : offsets[static_cast<std::size_t>(laser) % offsets.size()];
        const double azimuth =
            (turned_deg(o, start_us + firing_us(row, laser)) + offset_deg) * kRadPerDeg;
        bytes.channel(block, c, steps_to(o, row, laser, azimuth, echo == 1), echo == 1 ? 90 : 10);
      }
    }
  }
}

}  // namespace

double row_packet_us(const RowOptions& o) {
  const Row row = row_of(o);
  const auto cycles = 12 / (row.banks * echoes_stride(o));
  return static_cast<double>(cycles) * row.cycle_us;
}

std::vector<TimedPacket> row_packets(int count, const RowOptions& o) {
  const Row row = row_of(o);
  const int blocks = row.banks * echoes_stride(o);
  const int mode =
      o.drive.mode == Mode::dual ? o.dual_byte : (o.drive.mode == Mode::last ? 0x38 : 0x37);
  std::vector<TimedPacket> packets;
  for (int n = 0; n < count; ++n) {
    PacketBytes bytes;
    const double start_us = n * row_packet_us(o);
    for (int shot = 0; shot < 12 / blocks; ++shot)
      fill(bytes, o, row, shot * blocks, start_us + shot * row.cycle_us);
    bytes.tail(static_cast<std::uint8_t>(mode), static_cast<std::uint8_t>(row.product));
    const double stamp_us = o.drive.start_past_hour_s * 1e6 + start_us + row.stamp_us;
    bytes.stamp(static_cast<std::uint32_t>(static_cast<std::int64_t>(stamp_us) % 3'600'000'000));
    packets.push_back(
        {.bytes = bytes.take(),
         .received_ns = o.drive.start_received_ns +
                        static_cast<std::int64_t>((start_us + row_packet_us(o)) * 1e3)});
  }
  return packets;
}

}  // namespace lilo::test
