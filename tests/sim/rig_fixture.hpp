// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/vlp16_encoder.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace lilo::sim {

/// A sensor on a car in a scene that a test builds: flat ground at z = 0 and whatever `build` adds.
class TestRig {
 public:
  TestRig(SensorOptions sensor, const MotionOptions& motion, const std::vector<RouteSegment>& road,
          const std::function<void(Scene&)>& build,
          std::int64_t start_utc_ns = 1'700'000'000'000'000'000)
      : options(std::move(sensor)),
        route(road, 100.0),
        drive(motion, {}, route),
        path(motion, {.wander_m = 0.0}, route, drive, flat_ground()),
        rotor(options, 9),
        clock(start_utc_ns) {
    scene.terrain = flat_ground();
    build(scene);
    scene.finish();
  }
  TestRig(const TestRig&) = delete;
  TestRig& operator=(const TestRig&) = delete;

  [[nodiscard]] Rig rig() { return {options, path, rotor, clock, laser}; }

  static Terrain flat_ground() {
    return {{-300, -300, 300, 300}, 20.0, [](double, double) -> Terrain::Sample {
              return {0.0, Material::concrete};
            }};
  }

  SensorOptions options;
  Route route;
  Drive drive;
  SensorPath path;
  Rotor rotor;
  SensorClock clock;
  Scene scene;
  Laser laser{scene, path, options, 11};
};

/// Perfect echoes: what comes back is geometry alone.
inline SensorOptions noiseless(Sensor sensor = Sensor::vlp16) {
  SensorOptions options;
  options.sensor = sensor;
  options.range_sigma_m = 0.0;
  options.dropout = 0.0;
  return options;
}

inline unsigned u16_at(const Packet& packet, std::size_t at) {
  return packet.payload[at] | (static_cast<unsigned>(packet.payload[at + 1]) << 8U);
}
inline std::uint32_t u32_at(const Packet& packet, std::size_t at) {
  return u16_at(packet, at) | (u16_at(packet, at + 2) << 16U);
}

}  // namespace lilo::sim
