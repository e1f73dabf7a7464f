// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>

/// Sums over points, which give their mean and covariance.
namespace lilo::core {

/// Symmetric 3x3 matrix: xx xy xz yy yz zz.
using Symmetric = Eigen::Matrix<float, 6, 1>;

template <typename T>
Eigen::Matrix<T, 3, 3> matrix_of(const Eigen::Matrix<T, 6, 1>& s) {
  Eigen::Matrix<T, 3, 3> m;
  m << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return m;
}

inline Symmetric outer(const Eigen::Vector3f& v) {
  Symmetric o;
  o << v.x() * v.x(), v.x() * v.y(), v.x() * v.z(), v.y() * v.y(), v.y() * v.z(), v.z() * v.z();
  return o;
}

/// The number of points, the sums of x y z and those of xx xy xz yy yz zz. They are one array, so
/// that the compiler sums four at a time.
using Moments = std::array<float, 1 + 3 + 6>;

inline float count_of(const Moments& m) { return m[0]; }
inline Eigen::Map<const Eigen::Vector3f> points_of(const Moments& m) {
  return Eigen::Map<const Eigen::Vector3f>(&m[1]);
}
inline Eigen::Map<const Symmetric> squares_of(const Moments& m) {
  return Eigen::Map<const Symmetric>(&m[4]);
}

/// The sums of one point that stands for a surface around it with covariance `spread` * `around`.
inline Moments moments_of(const Eigen::Vector3f& point, float spread, const Symmetric& around) {
  const std::array<float, 4> p{1.0F, point.x(), point.y(), point.z()};
  Moments m{p[0],        p[1],        p[2],        p[3],        p[1] * p[1],
            p[1] * p[2], p[1] * p[3], p[2] * p[2], p[2] * p[3], p[3] * p[3]};
  for (std::size_t k = 4; k < m.size(); ++k) {
    m[k] += spread * around[static_cast<Eigen::Index>(k) - 4];
  }
  return m;
}

/// Keeps the part `kept` of the sums so far.
inline void add_to(Moments& sums, float kept, const Moments& more) {
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = kept * sums[k] + more[k];
}

}  // namespace lilo::core
