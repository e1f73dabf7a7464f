// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/noise_field.hpp"
#include "tools/sim/random.hpp"
#include "tools/sim/vehicles.hpp"
#include "tools/sim/world.hpp"

#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

/// Arc length of a traveller at one instant. Nobody keeps an exact speed.
double arc_of(const Traveller& traveller, const Drive& drive, double time_s, std::uint64_t seed) {
  const double sway = 1.5 * gradient_noise(seed, time_s / 4.0, 0.5);
  if (traveller.escort) return drive.arc_m(time_s) + traveller.start_m + 2.0 * sway;
  if (traveller.speed_mps == 0.0) return traveller.start_m;
  return traveller.start_m + traveller.speed_mps * (time_s + 0.15 * sway);
}

/// A walker's leg swings about the hip as it walks: `phase` in steps.
MoverState leg_state(const MoverState& body, double side, double phase) {
  const SinCos yaw = sin_cos(body.yaw_rad);
  const SinCos swing = sin_cos(std::numbers::pi * phase);
  MoverState leg = body;
  leg.position_m += Vec3(-0.1 * side * yaw.sin, 0.1 * side * yaw.cos, kHip_m);
  leg.pitch_rad = 0.5 * side * swing.sin;
  return leg;
}

}  // namespace

void add_travellers(World& world, const Drive& drive, double duration_s, std::uint64_t seed) {
  const int steps = static_cast<int>(duration_s / kMoverStep_s) + 3;
  std::uint64_t stream = 1000;
  for (const Traveller& traveller : world.travellers) {
    Random random(seed, stream++);
    const std::uint64_t sway_seed = random.next();
    const bool walker = traveller.kind == TravellerKind::walker;
    const double length = walker ? 0.4 : 2.6;  // over which the ground's slope is felt
    const double back = traveller.speed_mps < 0.0 ? std::numbers::pi : 0.0;
    Mover body, left, right;
    for (int k = 0; k < steps; ++k) {
      const double time = k * kMoverStep_s;
      const double arc = arc_of(traveller, drive, time, sway_seed);
      const double side =
          traveller.left_m + (walker ? 0.6 : 0.25) * gradient_noise(sway_seed + 1, arc / 9.0, 0.5);
      const RoutePoint p = world.route.at(arc);
      const Vec3 at = p.beside(side);
      const SinCos heading = sin_cos(p.yaw_rad + back);
      const auto height = [&](double ahead) {
        return world.scene.terrain.height(at.x() + ahead * heading.cos,
                                          at.y() + ahead * heading.sin);
      };
      MoverState state;
      const double front = height(0.5 * length), rear = height(-0.5 * length);
      state.position_m = {at.x(), at.y(), 0.5 * (front + rear)};
      state.yaw_rad = p.yaw_rad + back;
      state.pitch_rad = walker ? 0.0 : (rear - front) / length;
      body.states.push_back(state);
      if (!walker) continue;
      const double phase = (arc - traveller.start_m) / 0.7;
      left.states.push_back(leg_state(state, 1.0, phase));
      right.states.push_back(leg_state(state, -1.0, phase));
    }
    if (walker) {
      body.shape = world.scene.add_shape(make_walker_body(random));
      left.shape = right.shape = world.scene.add_shape(make_leg(random));
      world.scene.add_mover(std::move(left));
      world.scene.add_mover(std::move(right));
    } else {
      body.shape = world.scene.add_shape(traveller.heavy ? make_truck(random) : make_car(random));
    }
    world.scene.add_mover(std::move(body));
  }
}

}  // namespace lilo::sim
