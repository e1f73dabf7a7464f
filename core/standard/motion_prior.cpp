#include "core/standard/motion_prior.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace lilo::standard {
namespace {

using Knot = Eigen::Matrix<double, kKnotSize, 1>;

/// d(k+1) = Phi d(k): the deviation moves on at its rate.
KnotInformation transition(double dt_s) {
  KnotInformation phi = KnotInformation::Identity();
  phi.topRightCorner<6, 6>().diagonal().setConstant(dt_s);
  return phi;
}

}  // namespace

void add_prior(const Prior& prior, int segments, const Unknowns& x, NormalMatrix& H, Unknowns& b) {
  H.topLeftCorner<kKnotSize, kKnotSize>() += prior.begin_information;
  b.head<kKnotSize>() -= prior.begin_information * (x.head<kKnotSize>() - prior.begin_mean);
  const double dt_s = prior.span_s / segments;
  const KnotInformation phi = transition(dt_s);
  const KnotInformation W = process_information(prior.acceleration_density, dt_s);
  const KnotInformation Wphi = W * phi;
  for (int k = 0; k < segments; ++k) {
    const int i = kKnotSize * k, j = i + kKnotSize;
    const Knot e = x.segment<kKnotSize>(j) - phi * x.segment<kKnotSize>(i);
    H.block<kKnotSize, kKnotSize>(i, i) += phi.transpose() * Wphi;
    H.block<kKnotSize, kKnotSize>(i, j) -= Wphi.transpose();
    H.block<kKnotSize, kKnotSize>(j, i) -= Wphi;
    H.block<kKnotSize, kKnotSize>(j, j) += W;
    b.segment<kKnotSize>(i) += Wphi.transpose() * e;
    b.segment<kKnotSize>(j) -= W * e;
  }
}

Surprise surprise_of(const Prior& prior, int segments, const Unknowns& x) {
  const double dt_s = prior.span_s / segments;
  const KnotInformation phi = transition(dt_s);
  const KnotInformation W = process_information(prior.acceleration_density, dt_s);
  Surprise squares = Surprise::Zero(), count = Surprise::Zero();
  for (int k = 0; k < segments; ++k) {
    const int i = kKnotSize * k;
    const Knot e = x.segment<kKnotSize>(i + kKnotSize) - phi * x.segment<kKnotSize>(i);
    const Knot eWe = e.cwiseProduct(W * e);
    for (int axis = 0; axis < 6; ++axis) {
      const int unrest = kUnrestOf[static_cast<std::size_t>(axis)];
      if (unrest < 0) continue;
      squares[unrest] += eWe[axis] + eWe[axis + 6];
      count[unrest] += 2.0;
    }
  }
  return squares.cwiseQuotient(count);
}

Prior loosened(Prior prior, const Surprise& surprise) {
  for (int axis = 0; axis < 6; ++axis) {
    const int unrest = kUnrestOf[static_cast<std::size_t>(axis)];
    if (unrest >= 0) prior.acceleration_density[axis] *= std::max(1.0, surprise[unrest]);
  }
  return prior;
}

UnrestPull pull_of_unrest(const Prior& prior, int segments, const Unknowns& x) {
  UnrestPull pull = UnrestPull::Zero(x.size(), kUnrests);
  const double dt_s = prior.span_s / segments;
  const KnotInformation phi = transition(dt_s);
  const KnotInformation W = process_information(prior.acceleration_density, dt_s);
  for (int k = 0; k < segments; ++k) {
    const int i = kKnotSize * k, j = i + kKnotSize;
    // W goes with the inverse of the density, so what it adds to the right-hand side is taken away.
    const Knot We = W * (x.segment<kKnotSize>(j) - phi * x.segment<kKnotSize>(i));
    for (int axis = 0; axis < 6; ++axis) {
      const int unrest = kUnrestOf[static_cast<std::size_t>(axis)];
      if (unrest < 0) continue;
      Knot of_axis = Knot::Zero();
      of_axis[axis] = We[axis];
      of_axis[axis + 6] = We[axis + 6];
      pull.block<kKnotSize, 1>(i, unrest) -= phi.transpose() * of_axis;
      pull.block<kKnotSize, 1>(j, unrest) += of_axis;
    }
  }
  return pull;
}

KnotInformation process_information(const Vector6d& acceleration_density, double dt_s) {
  const Vector6d w = acceleration_density.cwiseInverse();
  KnotInformation W = KnotInformation::Zero();
  W.topLeftCorner<6, 6>().diagonal() = 12.0 / (dt_s * dt_s * dt_s) * w;
  W.topRightCorner<6, 6>().diagonal() = -6.0 / (dt_s * dt_s) * w;
  W.bottomLeftCorner<6, 6>().diagonal() = -6.0 / (dt_s * dt_s) * w;
  W.bottomRightCorner<6, 6>().diagonal() = 4.0 / dt_s * w;
  return W;
}

KnotInformation propagated(const KnotInformation& information, const Vector6d& acceleration_density,
                           double dt_s) {
  constexpr double kNoTime_s = 1e-5;  // from one firing to the next
  if (dt_s < kNoTime_s) return information;
  const KnotInformation phi = transition(dt_s);
  const KnotInformation Q = process_information(acceleration_density, dt_s).inverse();
  return (phi * information.inverse() * phi.transpose() + Q).inverse();
}

}  // namespace lilo::standard
