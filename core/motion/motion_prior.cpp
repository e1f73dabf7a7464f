// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/motion_prior.hpp"

#include "core/constants.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace lilo::core {
namespace {

/// d(k+1) = Phi d(k): the deviation moves on at its rate.
KnotInformation transition(double dt_s) {
  KnotInformation phi = KnotInformation::Identity();
  phi.topRightCorner<6, 6>().diagonal().setConstant(dt_s);
  return phi;
}

/// What is believed of the change from each knot to the next.
struct Step {
  KnotInformation phi, W;

  explicit Step(const Prior& prior)
      : phi(transition(prior.span_s / prior.segments)),
        W(process_information(prior.acceleration_density, prior.span_s / prior.segments)) {}

  /// By how much the knot that begins at unknown `i` fails to lead to the next one.
  [[nodiscard]] Knot error(const Unknowns& x, int i) const {
    return x.segment<kKnotSize>(i + kKnotSize) - phi * x.segment<kKnotSize>(i);
  }
};

/// With the process noise as it is.
void add_gaussian_prior(const Prior& prior, const Unknowns& x, NormalMatrix& H, Unknowns& b) {
  H.topLeftCorner<kKnotSize, kKnotSize>() += prior.begin_information;
  b.head<kKnotSize>() -= prior.begin_information * (x.head<kKnotSize>() - prior.begin_mean);
  const Step step(prior);
  const KnotInformation Wphi = step.W * step.phi;
  for (int k = 0; k < prior.segments; ++k) {
    const int i = kKnotSize * k, j = i + kKnotSize;
    const Knot e = step.error(x, i);
    H.block<kKnotSize, kKnotSize>(i, i) += step.phi.transpose() * Wphi;
    H.block<kKnotSize, kKnotSize>(i, j) -= Wphi.transpose();
    H.block<kKnotSize, kKnotSize>(j, i) -= Wphi;
    H.block<kKnotSize, kKnotSize>(j, j) += step.W;
    b.segment<kKnotSize>(i) += Wphi.transpose() * e;
    b.segment<kKnotSize>(j) -= step.W * e;
  }
}

}  // namespace

void observe_velocity(Prior& prior, const Eigen::Vector3d& velocity_mps,
                      const Eigen::Vector3d& information) {
  constexpr int kVelocity = 9;  // of a knot
  const Eigen::Vector3d lack_mps = velocity_mps - prior.T_begin.rotation * prior.twist.linear_mps;
  Knot sum = prior.begin_information * prior.begin_mean;
  sum.segment<3>(kVelocity) += information.cwiseProduct(lack_mps);
  prior.begin_information.diagonal().segment<3>(kVelocity) += information;
  prior.begin_mean = prior.begin_information.ldlt().solve(sum);
}

void add_prior(const Prior& prior, const Unknowns& x, NormalMatrix& H, Unknowns& b) {
  add_gaussian_prior(inflated(prior, normalised_innovation(prior, x)), x, H, b);
}

Vector6d mean_by_kind(const Vector6d& of_axes) {
  Vector6d mean = of_axes;
  mean.head<2>().setConstant(of_axes.head<2>().mean());
  mean.segment<2>(3).setConstant(of_axes.segment<2>(3).mean());
  return mean;
}

Vector6d normalised_innovation(const Prior& prior, const Unknowns& x) {
  const Step step(prior);
  Vector6d squares = Vector6d::Zero();
  for (int k = 0; k < prior.segments; ++k) {
    const Knot e = step.error(x, kKnotSize * k);
    const Knot eWe = e.cwiseProduct(step.W * e);
    squares += eWe.head<6>() + eWe.tail<6>();
  }
  return mean_by_kind(squares / (2.0 * prior.segments));
}

Prior inflated(Prior prior, const Vector6d& innovation) {
  prior.acceleration_density.array() *= innovation.array().max(1.0);
  return prior;
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

Matrix6d motion_information(const Prior& prior) {
  const double over_s = std::max(prior.span_s, motion::kComparedSpan_s);
  const KnotInformation noise = process_information(prior.acceleration_density, over_s);
  return prior.span_s / over_s * noise.inverse().topLeftCorner<6, 6>().inverse();
}

int segments_for(const Vector6d& acceleration_density, double span_s, int least) {
  const double density = acceleration_density.head<3>().mean();
  const double segment_s =
      std::cbrt(192.0 * motion::kKnotMotion_rad * motion::kKnotMotion_rad / density);
  const double wanted = std::ceil(span_s / segment_s);
  return static_cast<int>(std::clamp(wanted, std::min<double>(least, motion::kMaxSegments),
                                     double{motion::kMaxSegments}));
}

KnotInformation propagated(const KnotInformation& information, const Vector6d& acceleration_density,
                           double dt_s) {
  if (dt_s < motion::kLeastGap_s) return information;
  const KnotInformation phi = transition(dt_s);
  const KnotInformation Q = process_information(acceleration_density, dt_s).inverse();
  return (phi * information.inverse() * phi.transpose() + Q).inverse();
}

}  // namespace lilo::core
