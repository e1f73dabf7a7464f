// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/motion.hpp"
#include "tools/sim/noise_field.hpp"
#include "tools/sim/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

/// Height, pitch and roll of a body, or of the ground below its wheels.
struct Attitude {
  double z = 0.0, pitch = 0.0, roll = 0.0;
};

struct Stance {
  double x, y, yaw;
};

Stance stance_at(const MotionOptions& options, const Vehicle& vehicle, const Route& route,
                 double arc, double time_s) {
  const auto drift = [&](double s) {
    return vehicle.lane_m + vehicle.wander_m * gradient_noise(options.seed + 5, s / 22.0, 0.5);
  };
  const RoutePoint p = route.at(arc);
  const double left = drift(arc);
  const double slope = (drift(arc + 0.5) - drift(arc - 0.5)) / 1.0;  // heading follows the drift
  const Vec3 at = p.beside(left);
  // The turntable speeds up over a while, so that its rate is continuous.
  const double turning_s = time_s - options.standstill_s, ramp_s = options.turn_ramp_s;
  const double ramp = std::clamp(turning_s / ramp_s, 0.0, 1.0);
  const double turned =
      std::max(0.0, turning_s - ramp_s) + ramp_s * (ramp * ramp * ramp * (1.0 - 0.5 * ramp));
  const double spin = options.turn_rate_dps * std::numbers::pi / 180.0 * turned;
  return {at.x(), at.y(), p.yaw_rad + slope + spin};
}

Attitude ground_below(const Vehicle& vehicle, const Terrain& terrain, const Stance& stance) {
  const SinCos yaw = sin_cos(stance.yaw);
  const auto wheel = [&](double forward, double left) {
    return terrain.height(stance.x + forward * yaw.cos - left * yaw.sin,
                          stance.y + forward * yaw.sin + left * yaw.cos);
  };
  const double half_base = 0.5 * vehicle.wheelbase_m, half_track = 0.5 * vehicle.track_m;
  const double fl = wheel(half_base, half_track), fr = wheel(half_base, -half_track);
  const double rl = wheel(-half_base, half_track), rr = wheel(-half_base, -half_track);
  // REP-103: positive pitch is nose down, positive roll is left side up.
  return {0.25 * (fl + fr + rl + rr), 0.5 * (rl + rr - fl - fr) / vehicle.wheelbase_m,
          0.5 * (fl + rl - fr - rr) / vehicle.track_m};
}

/// Second-order springs between the ground and the body, in z, pitch and roll.
class Suspension {
 public:
  void settle(const Attitude& ground) {
    body_ = ground;
    rate_ = {};
  }
  const Attitude& step(const Attitude& ground, double dt) {
    pull(body_.z, rate_.z, ground.z, dt);
    pull(body_.pitch, rate_.pitch, ground.pitch, dt);
    pull(body_.roll, rate_.roll, ground.roll, dt);
    return body_;
  }

 private:
  static void pull(double& value, double& rate, double target, double dt) {
    constexpr double kOmega =
        2.0 * std::numbers::pi * 1.4;  // a car's body bounces at 1.2 to 1.6 Hz
    constexpr double kDamping = 0.4;
    rate += dt * (kOmega * kOmega * (target - value) - 2.0 * kDamping * kOmega * rate);
    value += dt * rate;
  }
  Attitude body_, rate_;
};

/// Added to pitch and roll of the body, as control points of the path's spline.
class Shake {
 public:
  explicit Shake(const MotionOptions& options) : Shake(options, Random(options.seed, 41)) {}
  void add_to(Attitude& body, double time_s, double speed_mps) const {
    constexpr double kFullSpeed_mps = 1.0;
    const double share = smoothstep(0.0, kFullSpeed_mps, speed_mps);
    body.pitch += share * pitch_.at(time_s);
    body.roll += share * roll_.at(time_s);
  }

 private:
  struct Wave {
    Wave(double hz, double rate_dps, double begin_rad)
        : omega_radps(2.0 * std::numbers::pi * hz), phase_rad(begin_rad) {
      // A cubic B-spline flattens a wave by the fourth power of sinc.
      const double half_rad = 0.5 * omega_radps * SensorPath::kKnot_s;
      const double sinc = sin_cos(half_rad).sin / half_rad;
      const double rate_radps = rate_dps * std::numbers::pi / 180.0;
      amplitude_rad = std::numbers::sqrt2 * rate_radps / omega_radps / (sinc * sinc * sinc * sinc);
    }
    [[nodiscard]] double at(double time_s) const {
      return amplitude_rad * sin_cos(omega_radps * time_s + phase_rad).sin;
    }
    double omega_radps, phase_rad, amplitude_rad;
  };
  static constexpr double kRollSlower = 0.8;

  Shake(const MotionOptions& options, Random random)
      : pitch_(options.shake_hz, options.shake_dps, random.angle()),
        roll_(kRollSlower * options.shake_hz, options.shake_dps, random.angle()) {}

  Wave pitch_, roll_;
};

/// From the sensor's axes to the body's.
Eigen::Matrix3d mount(const MotionOptions& options) {
  const SinCos tilt = sin_cos(options.tilt_deg * std::numbers::pi / 180.0);
  const SinCos roll = sin_cos(options.roll_deg * std::numbers::pi / 180.0);
  Eigen::Matrix3d nose_down, right_side_down;
  nose_down << tilt.cos, 0.0, tilt.sin, 0.0, 1.0, 0.0, -tilt.sin, 0.0, tilt.cos;
  right_side_down << 1.0, 0.0, 0.0, 0.0, roll.cos, -roll.sin, 0.0, roll.sin, roll.cos;
  return nose_down * right_side_down;
}

}  // namespace

SensorPath::SensorPath(const MotionOptions& options, const Vehicle& vehicle, const Route& route,
                       const Drive& drive, const Terrain& terrain) {
  mount_ = mount(options);
  constexpr int kSubsteps = 4;
  const double dt = kKnot_s / kSubsteps;
  const int knots = static_cast<int>(std::ceil((options.duration_s + 1.6) / kKnot_s));
  Suspension suspension;
  const Shake shake(options);
  for (int k = 0; k < knots; ++k) {
    Channels channels{};
    for (int sub = 0; sub < kSubsteps; ++sub) {
      const double time = -0.8 + k * kKnot_s + sub * dt;
      const double arc = drive.arc_m(time), speed = drive.speed_mps(time);
      const Stance stance = stance_at(options, vehicle, route, arc, time);
      Attitude ground = ground_below(vehicle, terrain, stance);
      const double ahead = (drive.speed_mps(time + 0.05) - drive.speed_mps(time - 0.05)) / 0.1;
      ground.pitch -= 0.008 * ahead;  // squats when it accelerates, dives when it brakes
      ground.roll += 0.010 * speed * speed * route.at(arc).curvature;  // leans out of the curve
      if (k == 0 && sub == 0) suspension.settle(ground);
      Attitude body = suspension.step(ground, dt);
      if (sub != 0) continue;
      shake.add_to(body, time, speed);
      const SinCos yaw = sin_cos(stance.yaw), pitch = sin_cos(body.pitch),
                   roll = sin_cos(body.roll);
      const double h = vehicle.sensor_height_m;
      // Third column of Rz(yaw) Ry(pitch) Rx(roll), times the mast.
      channels = {stance.x + h * (yaw.cos * pitch.sin * roll.cos + yaw.sin * roll.sin),
                  stance.y + h * (yaw.sin * pitch.sin * roll.cos - yaw.cos * roll.sin),
                  body.z + h * pitch.cos * roll.cos,
                  stance.yaw,
                  body.pitch,
                  body.roll};
    }
    controls_.push_back(channels);
  }
}

Placement SensorPath::at(double time_s) const {
  const double u = (time_s + 0.8) / kKnot_s;
  const auto last = static_cast<double>(controls_.size()) - 3.0;
  const double knot = std::clamp(std::floor(u), 1.0, last);
  const double s = std::clamp(u - knot, 0.0, 1.0), r = 1.0 - s;
  const auto k = static_cast<std::size_t>(knot);
  const std::array<double, 4> weight{r * r * r / 6.0, (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
                                     (3.0 * r * r * r - 6.0 * r * r + 4.0) / 6.0, s * s * s / 6.0};
  Channels v{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t c = 0; c < 6; ++c) v[c] += weight[i] * controls_[k - 1 + i][c];
  }
  const SinCos yaw = sin_cos(v[3]), pitch = sin_cos(v[4]), roll = sin_cos(v[5]);
  Eigen::Matrix3d body;
  body << yaw.cos * pitch.cos, yaw.cos * pitch.sin * roll.sin - yaw.sin * roll.cos,
      yaw.cos * pitch.sin * roll.cos + yaw.sin * roll.sin, yaw.sin * pitch.cos,
      yaw.sin * pitch.sin * roll.sin + yaw.cos * roll.cos,
      yaw.sin * pitch.sin * roll.cos - yaw.cos * roll.sin, -pitch.sin, pitch.cos * roll.sin,
      pitch.cos * roll.cos;
  Placement placement;
  placement.rotation.noalias() = body * mount_;
  placement.translation_m = {v[0], v[1], v[2]};
  return placement;
}

}  // namespace lilo::sim
