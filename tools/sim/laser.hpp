// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/bvh.hpp"
#include "tools/sim/motion.hpp"
#include "tools/sim/options.hpp"
#include "tools/sim/random.hpp"
#include "tools/sim/scene.hpp"

#include <array>

namespace lilo::sim {

struct Echo {
  double range_m = 0.0;  ///< 0: nothing came back
  std::uint8_t intensity = 0;
};

/// What one shot brought back. Where there is one echo all three are it.
struct Shot {
  Echo strongest, second, last;
};

/// Light on surfaces: range noise, brightness, and echoes too weak to be seen. The power that comes
/// back goes with reflectivity, cosine of incidence and 1/range^2; 10 % at 60 m, seen frontally, is
/// found every other time. In the modes `last` and `dual` a beam of 3 mrad is three rays, and edges
/// give two echoes.
class Laser {
 public:
  /// `path`: of the sensor; the parts of the robot move with it.
  Laser(const Scene& scene, const SensorPath& path, const SensorOptions& options,
        std::uint64_t seed);

  /// Shots are random numbers in the order of the calls. `origin` and `direction` in the world.
  Shot fire(const Vec3& origin, const Vec3& direction, double time_s);
  /// Distance to the surface itself, without noise; 0: none within the range limits.
  [[nodiscard]] double range_m(const Vec3& origin, const Vec3& direction, double time_s) const {
    return cast(origin, direction, time_s).range_m;
  }

 private:
  struct Glint {
    double range_m = 0.0, power = 0.0, brightness = 0.0;
  };
  void meet_robot(const Vec3& origin, const Vec3& direction, double time_s, Hit& hit) const;
  [[nodiscard]] Glint cast(const Vec3& origin, const Vec3& direction, double time_s) const;
  [[nodiscard]] Echo echo_of(const Glint& glint);
  Shot fire_wide(const Vec3& origin, const Vec3& direction, double time_s);

  const Scene& scene_;
  const SensorPath& path_;
  SolidMesh robot_;  // in the sensor's axes
  SensorOptions options_;
  Random random_;
};

}  // namespace lilo::sim
