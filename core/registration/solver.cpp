// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/solver.hpp"

#include "core/constants.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace lilo::core {
namespace {

/// J'OJ and -J'Or of a bin's residuals, by rotation and translation.
std::pair<Matrix6d, Vector6d> normal_equations(const ResidualSums& sums) {
  Matrix6d H;
  H.topLeftCorner<3, 3>() = matrix_of<double>(sums.head<6>());
  for (int row = 0; row < 3; ++row) {
    H.block<1, 3>(row, 3) = sums.segment<3>(6 + 3 * row).transpose();
  }
  H.bottomLeftCorner<3, 3>() = H.topRightCorner<3, 3>().transpose();
  H.bottomRightCorner<3, 3>() = matrix_of<double>(sums.segment<6>(15));
  return {H, sums.tail<6>()};
}

/// Whether it is higher above the sensor than any vehicle.
bool is_tall(const Feature& f) { return f.z_m > registration::kTall_m; }

KnotWeights weights_of_bin(int bin, const Prior& prior) {
  const double s = static_cast<double>(bin) / registration::kResidualInstants;
  return weights_at(s, prior.segments, prior.span_s);
}

/// The deviation of the pose from its prediction between two knots, or a step of the pose there.
Vector6d interpolated(const Unknowns& knots, const KnotWeights& w) {
  Vector6d deviation = Vector6d::Zero();
  for (int i = 0; i < 4; ++i) {
    deviation +=
        w.weight[static_cast<std::size_t>(i)] * knots.segment<6>(kKnotSize * w.first + 6 * i);
  }
  return deviation;
}

}  // namespace

/// Places the next features, many at a time, here and in match(), so that the memory's answers
/// overlap. Returns how many.
std::size_t Solver::look_up(const std::vector<Feature>& features, std::size_t first,
                            std::size_t stride) {
  std::size_t n = 0;
  for (std::size_t k = first; k < features.size() && n < correspondences_.size();
       k += stride, ++n) {
    Correspondence& one = correspondences_[n];
    const Feature& f = features[k];
    one.feature = &f;
    one.cached = &cached_cells_[k];
    one.turned_m = sampled_.turn(f.s, {f.x_m, f.y_m, f.z_m});
    one.point_m = one.turned_m.cast<double>() + sampled_.origin_m(f.s);
  }
  return n;
}

void Solver::match(std::span<Correspondence> some, LocalMaps& maps, Levels levels, Sides sides) {
  std::array<Correspondence*, kAtATime> unmatched;
  std::size_t n = 0;
  for (Correspondence& one : some) unmatched[n++] = &one;
  const std::size_t finest = LocalMaps::finest_of(levels);
  for (std::size_t level = finest; level < LocalMaps::kLevels && n > 0; ++level) {
    const auto left = std::span(unmatched).first(n);
    for (Correspondence* one : left) {
      one->key = maps.at(level, one->feature->kind).key_of(one->point_m, (*one->cached)[level]);
    }
    for (Correspondence* one : left) {
      one->cell = maps.at(level, one->feature->kind).cell_at(one->key);
      (*one->cached)[level] = one->cell;
      one->level = level;
    }
    n = 0;
    for (Correspondence* one : left) {
      Eigen::Vector3f ray = Eigen::Vector3f::Zero();
      if (sides == Sides::seen) ray = one->turned_m;
      one->match = maps.at(level, one->feature->kind).match(one->cell, one->point_m, ray);
      const bool is_decided = levels == Levels::first_known && one->match.is_known;
      if (one->match.information == nullptr && !is_decided) unmatched[n++] = one;
    }
  }
}

/// What vehicles in a jam show may be most of a scan, and moves. What stands higher than any of
/// them does not. All structure together keeps its information, so that the covariance does. The
/// weights stay the same over all steps: with weights that follow the matches the solver circles.
void Solver::weigh_by_height(const std::vector<Feature>& features, LocalMaps& maps,
                             const Prior& prior, Solution& solution) {
  height_weights_ = {};
  if (prior.twist.linear_mps.norm() > registration::kMaxJamSpeed_mps) return;
  const Sums sums =
      accumulate(features, registration::kFarStride, maps, Levels::from_whole, solution);
  const double all = sums.low + sums.tall;
  height_weights_.is_slow = true;
  if (!(all > 0.0)) return;
  const auto low = static_cast<float>(
      all / (sums.low + static_cast<double>(registration::kTallWeight) * sums.tall));
  height_weights_.low = low;
  height_weights_.tall = registration::kTallWeight * low;
}

float Solver::weight_by_height(const Feature& f) const {
  if (f.kind == FeatureKind::ground) return 1.0F;
  return is_tall(f) ? height_weights_.tall : height_weights_.low;
}

Solver::Sums Solver::accumulate(const std::vector<Feature>& features, std::size_t stride,
                                LocalMaps& maps, Levels levels, Solution& solution) {
  sample(solution.trajectory, sampled_);
  for (ResidualSums& bin : bins_) bin.setZero();
  Sums sums;
  solution.looked_up = solution.matched = 0;
  const float data_weight = config_.data_weight * static_cast<float>(stride);
  const float kernel_scale = static_cast<float>(stride);
  for (std::size_t k = 0, n = 0; k < features.size(); k += n * stride) {
    n = look_up(features, k, stride);
    solution.looked_up += static_cast<int>(n);
    const std::span some = std::span(correspondences_).first(n);
    match(some, maps, levels, sides_);
    for (const Correspondence& one : some) {
      if (one.match.information == nullptr) continue;
      ++solution.matched;
      add_residual(one, kernel_scale, data_weight * weight_by_height(*one.feature), sums);
    }
  }
  solution.inliers = sums.weights;
  solution.structure_inliers = sums.structure;
  solution.mean_square = sums.weights > 0.0 ? sums.squares / sums.weights : 0.0;
  sums.of_tall.is_slow = height_weights_.is_slow;
  solution.tall = sums.of_tall;
  return sums;
}

void Solver::add_residual(const Correspondence& one, float kernel_scale, float data_weight,
                          Sums& sums) {
  const bool ground = one.feature->kind == FeatureKind::ground;
  const Eigen::Vector3f& r = one.match.from_mean_m;
  const Symmetric& i = *one.match.information;
  const Eigen::Matrix3f O = matrix_of(i);
  const Eigen::Vector3f Or = O * r;
  const float square = r.dot(Or);
  const float kernel = kernel_scale * (ground ? config_.ground_kernel : config_.structure_kernel);
  const float robust = 1.0F / (1.0F + square / (kernel * kernel));
  sums.weights += static_cast<double>(robust);
  if (!ground) {
    sums.structure += static_cast<double>(robust);
    const bool tall = is_tall(*one.feature);
    (tall ? sums.tall : sums.low) += static_cast<double>(robust * O.trace());
    if (tall && height_weights_.is_slow) {
      sums.of_tall.information += (robust * O.topLeftCorner<2, 2>()).cast<double>();
      sums.of_tall.gradient -= (robust * Or.head<2>()).cast<double>();
    }
  }
  sums.squares += static_cast<double>(robust * square);
  // J = [-[p]x  I] with p as turned: [p]x crosses columns from the left, its transpose rows from
  // the right.
  const Eigen::Vector3f& p = one.turned_m;
  Eigen::Matrix3f C;  // [p]x O
  for (int k = 0; k < 3; ++k) C.col(k) = p.cross(O.col(k));
  const Eigen::Vector3f xx = p.cross(C.row(0)), yy = p.cross(C.row(1)), zz = p.cross(C.row(2));
  const Eigen::Vector3f pOr = p.cross(Or);
  const std::array<float, ResidualSums::RowsAtCompileTime> terms{
      xx[0],   xx[1],   xx[2],   yy[1],   yy[2],   zz[2],   C(0, 0), C(0, 1), C(0, 2),
      C(1, 0), C(1, 1), C(1, 2), C(2, 0), C(2, 1), C(2, 2), i[0],    i[1],    i[2],
      i[3],    i[4],    i[5],    -pOr[0], -pOr[1], -pOr[2], -Or[0],  -Or[1],  -Or[2]};
  const float w = robust * data_weight;
  // The nearest instant; std::lround() would be a call.
  const float and_half = one.feature->s * registration::kResidualInstants + 0.5F;
  double* sum = bins_[static_cast<std::size_t>(and_half)].data();
  for (std::size_t k = 0; k < terms.size(); ++k) sum[k] += static_cast<double>(w * terms[k]);
}

/// Of the pose, by all residuals as though they were independent.
Matrix6d Solver::data_information() const {
  Matrix6d sum = Matrix6d::Zero();
  for (const ResidualSums& bin : bins_) {
    sum += normal_equations(bin).first / static_cast<double>(config_.data_weight);
  }
  return sum;
}

/// Of the knots `x`, from all bins.
KnotEquations Solver::data_equations(const Prior& prior, const Unknowns& x,
                                     const DeadReckoning& reckoned) const {
  const int n = kKnotSize * (prior.segments + 1);
  KnotEquations all{NormalMatrix::Zero(n, n), Unknowns::Zero(n)};
  for (int bin = 0; bin <= registration::kResidualInstants; ++bin) {
    auto [A, c] = normal_equations(bins_[static_cast<std::size_t>(bin)]);
    const KnotWeights w = weights_of_bin(bin, prior);
    reckoned.hold(interpolated(x, w), A, c);
    for (int i = 0; i < 4; ++i) {
      const int row = kKnotSize * w.first + 6 * i;
      const double wi = w.weight[static_cast<std::size_t>(i)];
      all.b.segment<6>(row) += wi * c;
      for (int j = i; j < 4; ++j) {
        all.H.block<6, 6>(row, kKnotSize * w.first + 6 * j) +=
            wi * w.weight[static_cast<std::size_t>(j)] * A;
      }
    }
  }
  all.H.triangularView<Eigen::StrictlyLower>() = all.H.transpose();
  return all;
}

/// Residuals in one direction share their errors. The sums of the bins, taken as clusters, tell how
/// much less certain that makes the pose than independent residuals of one sigma would (Liang and
/// Zeger, 1986). `step`: the last one, which is not in the residuals yet.
Vector6d Solver::design_effect(const Unknowns& step, const Prior& prior) const {
  Vector6d squares = Vector6d::Zero(), expected = Vector6d::Zero();
  for (int bin = 0; bin <= registration::kResidualInstants; ++bin) {
    const auto [A, c] = normal_equations(bins_[static_cast<std::size_t>(bin)]);
    const KnotWeights w = weights_of_bin(bin, prior);
    squares += (c - A * interpolated(step, w)).cwiseAbs2();
    expected += static_cast<double>(config_.data_weight) * A.diagonal();
  }
  return squares.cwiseQuotient(expected.cwiseMax(1e-9));
}

Solution Solver::unaligned(const Prior& prior) const {
  Solution solution;
  solution.trajectory = {prior.T_begin, prior.twist, prior.span_s, prior.segments,
                         Unknowns::Zero(Eigen::Index{kKnotSize} * (prior.segments + 1))};
  solution.reported = {.T_odom_sensor = solution.trajectory.end(), .twist = prior.twist};
  return solution;
}

GaussNewtonStep Solver::step_from(const Unknowns& x, const Prior& prior,
                                  const DeadReckoning& reckoned) const {
  GaussNewtonStep one{.data = data_equations(prior, x, reckoned), .H = {}, .from = x, .step = {}};
  one.H = one.data.H;
  Unknowns b = one.data.b;
  add_prior(prior, x, one.H, b);
  one.step = one.H.ldlt().solve(b);
  return one;
}

Solution Solver::solve(const std::vector<Feature>& features, LocalMaps& maps, const Prior& prior,
                       Levels levels, Sides sides) {
  sides_ = sides;
  // Far from the solution residuals are larger than noise and what moves: a wide kernel first, then
  // the tight one (graduated non-convexity; Yang et al., RA-L 2020). And a part of the features
  // shows the way as well as all of them.
  std::size_t stride = registration::kFarStride;
  double last_step_m = std::numeric_limits<double>::infinity();
  Solution solution = unaligned(prior);
  const Eigen::Index n = solution.trajectory.knots.rows();
  solution.motion_information = motion_information(prior);
  DeadReckoning reckoned;  // none before the first step with all features; then as of that one
  bool is_first_with_all = true;
  cached_cells_.assign(features.size(), LocalMaps::kNoCells);
  weigh_by_height(features, maps, prior, solution);
  while (solution.iterations < config_.max_iterations && !solution.converged) {
    accumulate(features, stride, maps, stride == 1 ? levels : Levels::from_whole, solution);
    solution.data_information = data_information();
    if (stride == 1 && is_first_with_all) {
      reckoned = DeadReckoning(solution.data_information, solution.motion_information);
      is_first_with_all = false;
    }
    const GaussNewtonStep last = step_from(solution.trajectory.knots, prior, reckoned);
    if (!last.step.allFinite()) return unaligned(prior);
    solution.trajectory.knots += (stride == 1 ? registration::kOverRelaxation : 1.0) * last.step;
    ++solution.iterations;
    const Vector6d end = last.step.segment<6>(n - kKnotSize);
    const double step_m = magnitude_m(end.head<3>(), end.tail<3>());
    solution.converged = stride == 1 && step_m < registration::kConvergedStep_m;
    // With a part of the features the solution may circle: its steps grow no shorter.
    if (step_m < registration::kNearStep_m || step_m >= last_step_m) stride = 1;
    last_step_m = step_m;
    // The last step is always taken with all features.
    if (solution.iterations + 1 >= config_.max_iterations) stride = 1;
    if (solution.converged || solution.iterations == config_.max_iterations) {
      solution.end_information = marginal_of_last(last.H);
      solution.design_effect = design_effect(last.step, prior);
      solution.reported = reported_end(last, prior, solution.trajectory, solution.end_information);
    }
  }
  return solution;
}

}  // namespace lilo::core
