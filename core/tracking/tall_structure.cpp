// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/tall_structure.hpp"

#include "core/constants.hpp"
#include "core/motion/scan_timing.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <cmath>

namespace lilo::core {

std::optional<TallEquations> tall_equations(const Solution& solution, bool is_lost, bool is_room) {
  if (is_lost || is_room) return TallEquations{};
  if (solution.tall.is_slow && !solution.converged) return std::nullopt;
  return solution.tall;
}

void TallStructure::observe(const std::optional<TallEquations>& scan, bool is_doubted,
                            std::int64_t end_ns) {
  if (scan) is_slow_ = scan->is_slow;
  if (!is_slow_) {
    forget_scans();
  } else if (scan) {
    information_ += tracking::kTallSmoothing * (scan->information - information_);
    gradient_ += tracking::kTallSmoothing * (scan->gradient - gradient_);
    scans_elsewhere_ = is_elsewhere() ? scans_elsewhere_ + 1 : 0;
  }
  if (is_doubted || (scan && disagrees())) doubted_ns_ = end_ns;
  if (doubted_ns_) {
    const double since_s = seconds_between(*doubted_ns_, end_ns);
    if (since_s < 0.0 || since_s >= tracking::kTraffic_s) doubted_ns_.reset();
  }
  is_missing_ = is_slow_ && doubted_ns_ && !confirms();
}

void TallStructure::forget_scans() {
  information_.setZero();
  gradient_.setZero();
  scans_elsewhere_ = 0;
}

bool TallStructure::disagrees() const { return scans_elsewhere_ >= tracking::kTallScans; }

bool TallStructure::is_elsewhere() const {
  // A direction of which nothing is known: 1 sigma of 10 m.
  const Eigen::Matrix2d H = information_ + 0.01 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d off_m = H.ldlt().solve(gradient_);
  return std::sqrt(gradient_.dot(off_m)) > tracking::kTallSigmas &&
         off_m.norm() > tracking::kTallOff_m;
}

/// Whether it tells the place along every horizontal direction, and agrees.
bool TallStructure::confirms() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> by_axis(information_,
                                                               Eigen::EigenvaluesOnly);
  constexpr double kLeast = 1.0 / (tracking::kTallKnown_m * tracking::kTallKnown_m);
  return by_axis.eigenvalues()[0] > kLeast && !is_elsewhere();
}

}  // namespace lilo::core
