// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/laser.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lilo::sim {
namespace {

constexpr double kRetro = 8.0;  ///< a reflector sends back this many times a white wall's light

/// At 905 nm, by what people measure with a Velodyne; plants are bright in the infrared.
double reflectivity(Material material) {
  switch (material) {
    case Material::asphalt:
      return 0.17;
    case Material::concrete:
      return 0.35;
    case Material::grass:
      return 0.45;
    case Material::soil:
      return 0.25;
    case Material::plaster:
      return 0.6;
    case Material::brick:
      return 0.35;
    case Material::glass:
      return 0.06;
    case Material::metal:
      return 0.3;
    case Material::paint:
      return 0.4;
    case Material::bark:
      return 0.3;
    case Material::leaf:
      return 0.5;
    case Material::cloth:
      return 0.3;
    case Material::retro:
      return kRetro;
  }
  return 0.3;
}

Mesh mesh_of(const std::vector<RobotBox>& robot) {
  Mesh mesh;
  for (const RobotBox& box : robot) {
    add_box(mesh, {box[0], box[2], box[4]}, {box[1], box[3], box[5]}, Material::paint);
  }
  return mesh;
}

}  // namespace

Laser::Laser(const Scene& scene, const SensorPath& path, const SensorOptions& options,
             std::uint64_t seed)
    : scene_(scene),
      path_(path),
      robot_(mesh_of(options.robot)),
      options_(options),
      random_(seed, 50) {}

void Laser::meet_robot(const Vec3& origin, const Vec3& direction, double time_s, Hit& hit) const {
  if (robot_.size() == 0) return;
  const Placement pose = path_.at(time_s);
  const Eigen::Matrix3d back = pose.rotation.transpose();
  Hit nearer{hit.range_m};
  robot_.cast(Ray(back * (origin - pose.translation_m), back * direction), nearer);
  if (!nearer.found) return;
  hit = nearer;
  hit.normal = pose.rotation * nearer.normal;
}

Laser::Glint Laser::cast(const Vec3& origin, const Vec3& direction, double time_s) const {
  Hit hit = scene_.cast(origin, direction, time_s, options_.max_range_m);
  meet_robot(origin, direction, time_s, hit);
  if (!hit.found || hit.range_m < options_.min_range_m) return {};
  double cosine = std::abs(hit.normal.dot(direction));
  // Glass mirrors: what is not met nearly at a right angle goes elsewhere.
  if (hit.material == Material::glass) cosine = cosine * cosine * cosine * cosine;
  const double light = reflectivity(hit.material) * cosine;
  const double ratio = 60.0 / hit.range_m;
  return {hit.range_m, light / 0.1 * ratio * ratio, light};
}

Echo Laser::echo_of(const Glint& glint) {
  if (glint.range_m <= 0.0) return {};
  // Two numbers a shot, whatever comes of it: one lost echo must not change all later noise.
  const double luck = random_.uniform(), noise = random_.normal();
  if (options_.dropout > 0.0) {
    const double faint = smoothstep(0.5, 2.0, 1.0 / std::max(glint.power, 1e-9));
    if (luck < options_.dropout + (1.0 - options_.dropout) * faint) return {};
  }
  // 0 to 100 is a diffuse surface of that reflectivity in percent, above are reflectors.
  const double bright = glint.brightness <= 1.0 ? 100.0 * glint.brightness
                                                : 100.0 + 155.0 * glint.brightness / kRetro;
  return {glint.range_m + options_.range_sigma_m * noise,
          static_cast<std::uint8_t>(std::clamp(bright + 2.0 * noise, 1.0, 255.0))};
}

Shot Laser::fire(const Vec3& origin, const Vec3& direction, double time_s) {
  if (options_.returns != ReturnMode::strongest) return fire_wide(origin, direction, time_s);
  const Echo echo = echo_of(cast(origin, direction, time_s));
  return {echo, echo, echo};
}

Shot Laser::fire_wide(const Vec3& origin, const Vec3& direction, double time_s) {
  constexpr double kHalfDivergence_rad = 0.0015;
  constexpr double kApart_m = 0.5;  // nearer echoes flow into one
  const Vec3 across = direction.cross(Vec3(0.0, 0.0, 1.0)).normalized();
  const Vec3 up = across.cross(direction);
  std::array<Glint, 3> echoes{};
  std::size_t count = 0;
  for (int ray = 0; ray < 3; ++ray) {
    Vec3 aim = direction;
    if (ray > 0) {
      const SinCos a = sin_cos(random_.angle());
      aim = (direction + kHalfDivergence_rad * (a.cos * across + a.sin * up)).normalized();
    }
    Glint glint = cast(origin, aim, time_s);
    if (glint.range_m <= 0.0) continue;
    glint.power /= 3.0;
    glint.brightness /= 3.0;
    std::size_t same = 0;
    while (same < count && std::abs(echoes[same].range_m - glint.range_m) >= kApart_m) ++same;
    if (same == count) {
      echoes[count++] =
          glint;  // its range stays that of its first ray, the beam's middle if it hit
    } else {
      echoes[same].power += glint.power;
      echoes[same].brightness += glint.brightness;
    }
  }
  Shot shot;
  double best = -1.0, next = -1.0;
  for (std::size_t k = 0; k < count; ++k) {
    const Echo echo = echo_of(echoes[k]);
    if (echo.range_m <= 0.0) continue;
    const double power = echoes[k].power;
    if (power > best) {
      next = std::exchange(best, power);
      shot.second = std::exchange(shot.strongest, echo);
    } else if (power > next) {
      next = power;
      shot.second = echo;
    }
    if (echo.range_m > shot.last.range_m) shot.last = echo;
  }
  if (next < 0.0) shot.second = shot.strongest;
  return shot;
}

}  // namespace lilo::sim
