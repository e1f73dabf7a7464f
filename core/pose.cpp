// SPDX-License-Identifier: BSD-3-Clause
#include "core/pose.hpp"

#include "core/constants.hpp"

#include <algorithm>
#include <cmath>

namespace lilo {

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& w) {
  const double h2 = 0.25 * w.squaredNorm();  // of half the angle
  double cosine, half_sine_part;             // cos h, sin h / 2h
  if (h2 < 0.0025) {
    // Near zero the quotient loses its digits; up to 0.1 rad Taylor's series has all of them, and
    // asks for neither sine nor cosine.
    cosine = 1.0 - h2 / 2.0 * (1.0 - h2 / 12.0 * (1.0 - h2 / 30.0));
    half_sine_part = 0.5 * (1.0 - h2 / 6.0 * (1.0 - h2 / 20.0 * (1.0 - h2 / 42.0)));
  } else {
    const double h = std::sqrt(h2);
    cosine = std::cos(h);
    half_sine_part = 0.5 * std::sin(h) / h;
  }
  const Eigen::Vector3d v = half_sine_part * w;
  return Eigen::Quaterniond(cosine, v.x(), v.y(), v.z()).normalized();
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // q and -q are one rotation: take the short way
  const Eigen::Vector3d v = sign * q.vec();
  const double s = v.norm();
  const double angle = 2.0 * std::atan2(s, sign * q.w());
  return s < 1e-9 ? Eigen::Vector3d(2.0 * v) : Eigen::Vector3d(v * (angle / s));
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Pose Pose::operator*(const Pose& other) const {
  return {(rotation * other.rotation).normalized(), *this * other.translation_m};
}

Pose Pose::inverse() const {
  const Eigen::Quaterniond back = rotation.conjugate();
  return {back, -(back * translation_m)};
}

double magnitude_m(const Eigen::Vector3d& turned_rad, const Eigen::Vector3d& moved_m) {
  return std::max(moved_m.norm(), core::motion::kLever_m * turned_rad.norm());
}

double magnitude_m(const Pose& T) { return magnitude_m(so3_log(T.rotation), T.translation_m); }

Pose scale_motion(const Pose& T, double s) {
  return {so3_exp(s * so3_log(T.rotation)), s * T.translation_m};
}

Pose interpolate(const Pose& a, const Pose& b, double s) {
  const Eigen::Vector3d w = so3_log(a.rotation.conjugate() * b.rotation);
  return {(a.rotation * so3_exp(s * w)).normalized(),
          a.translation_m + s * (b.translation_m - a.translation_m)};
}

}  // namespace lilo
