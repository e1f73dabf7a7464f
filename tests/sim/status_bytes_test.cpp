// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/status_bytes.hpp"

#include "tools/sim/hdl64_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

// Positions and units from the S3 manual, pp. 31-38.
namespace lilo::sim {
namespace {

constexpr std::int64_t kUtc_s = 1'795'255'199;  // 2026-11-21 09:59:59

struct Lap {
  std::string types;
  std::vector<std::uint8_t> table;  ///< the 1820 bytes after the nine of date and state
};

Lap read_lap(const StatusBytes& status) {
  Lap lap;
  for (std::uint64_t n = 0; n < 4160; ++n) {
    const StatusBytes::Pair pair = status.at(n, kUtc_s);
    lap.types += static_cast<char>(pair.type);
    if (n % 16 >= 9) lap.table.push_back(pair.value);
  }
  return lap;
}

int word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8));
}

SensorOptions options(Sensor sensor) {
  SensorOptions options;
  options.sensor = sensor;
  return options;
}

TEST(StatusBytes, CrcIsTheCataloguesCrc16Umts) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc16({digits.begin(), digits.end()}), 0xFEE8);
}

TEST(StatusBytes, CyclesStartWithDateAndState) {
  const auto table = make_hdl64_table(Sensor::hdl64_s3, true, 1);
  const StatusBytes status(options(Sensor::hdl64_s3), table);
  const Lap lap = read_lap(status);
  for (std::size_t n = 0; n < lap.types.size(); n += 16)
    EXPECT_EQ(lap.types.substr(n, 9), "HMSDNYGTV");
  const std::vector<int> values{9, 59, 59, 21, 11, 26, 'A'};
  for (std::size_t k = 0; k < values.size(); ++k)
    EXPECT_EQ(status.at(160 + k, kUtc_s).value, values[k]);
  EXPECT_EQ(lap.types.substr(9, 7), "12345\xF7\xF6");
  EXPECT_EQ(lap.types.substr(16 * 4 + 9, 7), "W234567");  // the reserved cycle of the first laser
  EXPECT_EQ(lap.types.substr(16 * 257 + 9, 7),
            "\xFE\xFF\xFC\xFD\xFA\xFB"
            "7");
  EXPECT_EQ(lap.types.substr(16 * 259 + 9, 7),
            "12\xF9"
            "4\xF8"
            "67");
  EXPECT_EQ(status.at(4160 + 33, kUtc_s).value, status.at(33, kUtc_s).value);  // laps repeat
}

TEST(StatusBytes, TableIsTheUnits) {
  for (const Sensor sensor : {Sensor::hdl64_s2, Sensor::hdl64_s3}) {
    const auto table = make_hdl64_table(sensor, true, 5);
    const Lap lap = read_lap(StatusBytes(options(sensor), table));
    ASSERT_EQ(lap.table.size(), 1820U);
    EXPECT_EQ(std::string(lap.table.begin(), lap.table.begin() + 5), "UNIT#");
    std::vector<std::uint8_t> covered;
    for (std::size_t k = 0; k < 64; ++k) {
      const std::size_t at = 7 + 28 * k;
      const LaserCorrection& c = table[k];
      EXPECT_EQ(lap.table[at], k);
      EXPECT_NEAR(word(lap.table, at + 1) * 0.01, c.elevation_rad * 180.0 / std::numbers::pi, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 3) * 0.01, c.rotation_rad * 180.0 / std::numbers::pi, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 5) * 1e-3, c.distance_m, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 7) * 1e-3, c.distance_x_m, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 9) * 1e-3, c.distance_y_m, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 11) * 1e-3, c.vertical_offset_m, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 13) * 1e-3, c.horizontal_offset_m, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 15) * 1e-3, c.focal_distance_m, 1e-9);
      EXPECT_NEAR(word(lap.table, at + 17) * 0.1, c.focal_slope, 1e-9);
      EXPECT_EQ(lap.table[at + 19], c.min_intensity);
      EXPECT_EQ(lap.table[at + 20], c.max_intensity);
      covered.insert(covered.end(), lap.table.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                     lap.table.begin() + static_cast<std::ptrdiff_t>(at) + 21);
    }
    EXPECT_EQ(word(lap.table, 1820 - 21), 600);  // rpm
    EXPECT_EQ(lap.table[1820 - 5], 0);           // strongest return
    const auto check = static_cast<std::uint16_t>(word(lap.table, 1818));
    EXPECT_EQ(check, sensor == Sensor::hdl64_s3 ? crc16(covered) : 1820);
  }
}

}  // namespace
}  // namespace lilo::sim
