#include "core/standard/motion_prior.hpp"

#include <Eigen/LU>

namespace lilo::standard {
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

  Step(const Prior& prior, int segments)
      : phi(transition(prior.span_s / segments)),
        W(process_information(prior.acceleration_density, prior.span_s / segments)) {}

  /// By how much the knot that begins at unknown `i` fails to lead to the next one.
  [[nodiscard]] Knot error(const Unknowns& x, int i) const {
    return x.segment<kKnotSize>(i + kKnotSize) - phi * x.segment<kKnotSize>(i);
  }
};

}  // namespace

void add_prior(const Prior& prior, int segments, const Unknowns& x, NormalMatrix& H, Unknowns& b) {
  H.topLeftCorner<kKnotSize, kKnotSize>() += prior.begin_information;
  b.head<kKnotSize>() -= prior.begin_information * (x.head<kKnotSize>() - prior.begin_mean);
  const Step step(prior, segments);
  const KnotInformation Wphi = step.W * step.phi;
  for (int k = 0; k < segments; ++k) {
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

Eigen::Matrix<double, 6, kUnrests> unrest_axes() {
  Eigen::Matrix<double, 6, kUnrests> axes;
  axes.col(0) << 1, 1, 0, 0, 0, 0;
  axes.col(1) << 0, 0, 0, 0, 0, 1;
  return axes;
}

PerUnrest surprise_of(const Prior& prior, int segments, const Unknowns& x) {
  const Step step(prior, segments);
  Vector6d squares = Vector6d::Zero();
  for (int k = 0; k < segments; ++k) {
    const Knot e = step.error(x, kKnotSize * k);
    const Knot eWe = e.cwiseProduct(step.W * e);
    squares += eWe.head<6>() + eWe.tail<6>();
  }
  const Eigen::Matrix<double, 6, kUnrests> axes = unrest_axes();
  const PerUnrest count = 2.0 * segments * axes.colwise().sum();
  return (axes.transpose() * squares).cwiseQuotient(count);
}

Prior loosened(Prior prior, const PerUnrest& surprise) {
  const PerUnrest more = surprise.cwiseMax(1.0) - PerUnrest::Ones();
  prior.acceleration_density.array() *= 1.0 + (unrest_axes() * more).array();
  return prior;
}

UnrestPull pull_of_unrest(const Prior& prior, int segments, const Unknowns& x) {
  UnrestPull pull = UnrestPull::Zero(x.size(), kUnrests);
  const Step step(prior, segments);
  using OfKnot = Eigen::Matrix<double, kKnotSize, kUnrests>;  // of d and of its rate
  const OfKnot axes = unrest_axes().replicate<2, 1>();
  for (int k = 0; k < segments; ++k) {
    const int i = kKnotSize * k, j = i + kKnotSize;
    // W goes with the inverse of the density, so what it adds to the right-hand side is taken away.
    const Knot We = step.W * step.error(x, i);
    const OfKnot by_kind = We.asDiagonal() * axes;
    pull.middleRows<kKnotSize>(i) -= step.phi.transpose() * by_kind;
    pull.middleRows<kKnotSize>(j) += by_kind;
  }
  return pull;
}

Vector6d wildest_begin(Prior prior, int segments, const Unknowns& x, NormalMatrix H, Unknowns b) {
  prior.acceleration_density = prior.acceleration_density.cwiseMax(prior.wildest_density);
  add_prior(prior, segments, x, H, b);
  const Unknowns step = H.ldlt().solve(b);
  return x.head<6>() + step.head<6>();
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
