// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>
#include <vector>

namespace lilo::paper {
namespace {

constexpr std::size_t kMinNeighbours = 5;
constexpr int kMinCorrespondences = 30;

struct Spread {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d eigenvalues = Eigen::Vector3d::Zero();  // ascending, m^2
  Eigen::Matrix3d eigenvectors = Eigen::Matrix3d::Identity();
};

Spread spread_of(const Cloud& map, const std::vector<int>& indices) {
  Spread s;
  for (const int k : indices) {
    s.mean += map[static_cast<std::size_t>(k)].getVector3fMap().cast<double>();
  }
  s.mean /= static_cast<double>(indices.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const int k : indices) {
    const Eigen::Vector3d d =
        map[static_cast<std::size_t>(k)].getVector3fMap().cast<double>() - s.mean;
    covariance += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance / static_cast<double>(indices.size()));
  s.eigenvalues = solver.eigenvalues();
  s.eigenvectors = solver.eigenvectors();
  return s;
}

/// Normal equation of one Gauss-Newton step.
struct Normal {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double squared_sum = 0.0;
  int count = 0;

  template <typename Jacobian, typename Value>
  void add(const Jacobian& J, const Value& r, double squared, double huber_m) {
    const double norm = std::sqrt(squared);
    const double weight = norm <= huber_m ? 1.0 : huber_m / norm;
    H.noalias() += weight * J.transpose() * J;
    b.noalias() -= weight * J.transpose() * r;
    squared_sum += squared;
    ++count;
  }
};

/// The line or plane a feature is matched with, and where the feature was when it was sought.
struct Match {
  Eigen::Vector3f sought_at = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Primitive primitive;
};
using Matches = std::vector<Match>;

struct Search {
  const LocalMap& map;
  double radius_m;
  double stay_m;  ///< a feature that moved less keeps its match
  std::int64_t& neighbours_left;
  Primitive (*fit)(const Cloud&, const std::vector<int>&);
};

/// Seeks again when the feature has moved since it was sought.
void update(const Search& search, const Point& point, const Pose& T, Match& match) {
  Point q = point;
  q.getVector3fMap() = (T * point.getVector3fMap().cast<double>()).cast<float>();
  const auto stay_m = static_cast<float>(search.stay_m);
  if ((q.getVector3fMap() - match.sought_at).squaredNorm() < stay_m * stay_m) return;
  if (search.neighbours_left <= 0) return;
  const std::vector<int>& neighbours = search.map.neighbours(q, search.radius_m);
  search.neighbours_left -= static_cast<std::int64_t>(neighbours.size());
  match.sought_at = q.getVector3fMap();
  match.primitive = search.fit(search.map.cloud(), neighbours);
}

void add_edges(const Cloud& edges, const Search& search, const Pose& T, double huber_m,
               Matches& matches, Normal& normal) {
  for (std::size_t k = 0; k < edges.size(); ++k) {
    update(search, edges[k], T, matches[k]);
    const Primitive& line = matches[k].primitive;
    if (!line.valid) continue;
    const LineResidual r = line_residual(T, edges[k].getVector3fMap().cast<double>(), line);
    normal.add(r.jacobian, r.value, r.value.squaredNorm(), huber_m);
  }
}

void add_surfaces(const Cloud& surfaces, const Search& search, const Pose& T, double huber_m,
                  Matches& matches, Normal& normal) {
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    update(search, surfaces[k], T, matches[k]);
    const Primitive& plane = matches[k].primitive;
    if (!plane.valid) continue;
    const PlaneResidual r = plane_residual(T, surfaces[k].getVector3fMap().cast<double>(), plane);
    normal.add(r.jacobian, Eigen::Matrix<double, 1, 1>(r.value), r.value * r.value, huber_m);
  }
}

}  // namespace

Primitive fit_line(const Cloud& map, const std::vector<int>& indices) {
  if (indices.size() < kMinNeighbours) return {};
  const Spread s = spread_of(map, indices);
  const bool valid = s.eigenvalues[2] > 3.0 * s.eigenvalues[1] && s.eigenvalues[2] > 0.0;
  return {s.mean, s.eigenvectors.col(2), valid};
}

Primitive fit_plane(const Cloud& map, const std::vector<int>& indices) {
  constexpr double kMaxThickness2 = 0.1 * 0.1;
  if (indices.size() < kMinNeighbours) return {};
  const Spread s = spread_of(map, indices);
  const bool valid = s.eigenvalues[0] < kMaxThickness2 && s.eigenvalues[1] > 3.0 * s.eigenvalues[0];
  return {s.mean, s.eigenvectors.col(0), valid};
}

LineResidual line_residual(const Pose& T, const Eigen::Vector3d& p, const Primitive& line) {
  const Eigen::Vector3d q = T * p;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - line.axis * line.axis.transpose();
  LineResidual r;
  r.value = across * (q - line.point);
  r.jacobian.leftCols<3>() = -across * skew(q - T.translation_m);
  r.jacobian.rightCols<3>() = across;
  return r;
}

PlaneResidual plane_residual(const Pose& T, const Eigen::Vector3d& p, const Primitive& plane) {
  const Eigen::Vector3d q = T * p;
  PlaneResidual r;
  r.value = (q - plane.point).dot(plane.axis);
  r.jacobian.leftCols<3>() = (q - T.translation_m).cross(plane.axis).transpose();
  r.jacobian.rightCols<3>() = plane.axis.transpose();
  return r;
}

Alignment align(const Cloud& edges, const Cloud& surfaces, const LocalMap& edge_map,
                const LocalMap& surface_map, const Pose& guess, double search_m,
                const PaperConfig& config, std::int64_t& neighbours_left) {
  constexpr double kRotationEnough_rad = 1e-4;
  constexpr double kTranslationEnough_m = 1e-3;
  Alignment result;
  result.T_odom_sensor = guess;
  Pose& T = result.T_odom_sensor;
  const double stay_m = config.search_again * search_m;
  const Search lines{edge_map, search_m, stay_m, neighbours_left, fit_line};
  const Search planes{surface_map, search_m, stay_m, neighbours_left, fit_plane};
  Matches edge_matches(edges.size());
  Matches surface_matches(surfaces.size());
  while (result.iterations < config.max_iterations && !result.converged) {
    Normal normal;
    add_edges(edges, lines, T, config.huber_m, edge_matches, normal);
    add_surfaces(surfaces, planes, T, config.huber_m, surface_matches, normal);
    result.correspondences = normal.count;
    if (normal.count < kMinCorrespondences || neighbours_left <= 0) break;
    const Vector6d step = normal.H.ldlt().solve(normal.b);
    if (!step.allFinite()) break;
    T.rotation = (so3_exp(step.head<3>()) * T.rotation).normalized();
    T.translation_m += step.tail<3>();
    ++result.iterations;
    result.information = normal.H;
    result.residual_rms_m = std::sqrt(normal.squared_sum / normal.count);
    result.converged =
        step.head<3>().norm() < kRotationEnough_rad && step.tail<3>().norm() < kTranslationEnough_m;
  }
  return result;
}

}  // namespace lilo::paper
