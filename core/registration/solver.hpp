// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_correction.hpp"
#include "core/calibration/beam_equations.hpp"
#include "core/constants.hpp"
#include "core/feature.hpp"
#include "core/map/local_maps.hpp"
#include "core/motion/motion_prior.hpp"
#include "core/motion/motion_state.hpp"
#include "core/motion/trajectory.hpp"
#include "core/odometry_config.hpp"
#include "core/registration/reported_end.hpp"
#include "core/registration/weak_directions.hpp"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

/// Alignment of one scan with the local map: Gauss-Newton over the knots of its trajectory.
namespace lilo::core {

/// Defaults are those of DefaultConfig, where each is explained.
struct SolverConfig {
  int max_iterations = DefaultConfig{}.max_iterations;
  float ground_kernel = static_cast<float>(DefaultConfig{}.ground_kernel);
  float structure_kernel = static_cast<float>(DefaultConfig{}.structure_kernel);
  float data_weight = static_cast<float>(DefaultConfig{}.data_weight);
};

/// What structure taller than any vehicle says of the horizontal place of a slow sensor, its
/// attitude as aligned: H and b of H x = b, along the odometry's axes, by residuals that count as
/// independent.
struct TallEquations {
  bool is_slow = false;  ///< at most registration::kMaxJamSpeed_mps; else all is zero
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  ///< 1/m^2
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();     ///< 1/m
};

struct Solution {
  Trajectory trajectory;
  MotionState reported;  ///< its end as it is reported (reported_end()), without its stamp
  KnotInformation end_information = KnotInformation::Zero();  ///< marginal of the last knot
  /// Of the pose by the scan alone, as though its residuals were independent.
  Matrix6d data_information = Matrix6d::Zero();
  /// Of the pose by the motion alone, for comparison with it (motion_information()).
  Matrix6d motion_information = Matrix6d::Zero();
  /// Variance of the pose over that by independent residuals of one sigma; by axis.
  Vector6d design_effect = Vector6d::Zero();
  int looked_up = 0;             ///< features looked up
  int matched = 0;               ///< features that found a distribution
  double inliers = 0;            ///< sum of robust weights
  double structure_inliers = 0;  ///< the same of structure alone
  double mean_square = 0.0;      ///< weighted mean of squared residuals in sigmas
  TallEquations tall;            ///< before the last step
  int iterations = 0;
  bool converged = false;
};

/// Sums over residuals, for a pose (rotation, translation): of the symmetric matrix J'OJ the block
/// of the rotation (xx xy xz yy yz zz), the block beside it row by row, and the block of the
/// translation; then -J'Or.
using ResidualSums = Eigen::Matrix<double, 6 + 9 + 6 + 6, 1>;

/// Which sides of the map's surfaces a scan may be matched with.
enum class Sides {
  seen,  ///< those from which they were seen
  both   ///< the other ones, too: a thin wall may then be off by its width
};

/// Aligns features with the maps. Keeps its working memory between calls.
class Solver {
 public:
  /// Reserves memory for `most_features` in one solve().
  Solver(const SolverConfig& config, std::size_t most_features) : config_(config) {
    cached_cells_.reserve(most_features);
  }
  /// The prediction as a solution in which nothing matched.
  [[nodiscard]] Solution unaligned(const Prior& prior) const;
  /// `levels`: of the maps, used once the solution is near.
  Solution solve(const std::vector<Feature>& features, LocalMaps& maps, const Prior& prior,
                 Levels levels = Levels::from_whole, Sides sides = Sides::seen);

  /// What the residuals of a solution say of the beams. The map is as it was for solve().
  BeamEquations beam_equations(const std::vector<Feature>& features, LocalMaps& maps,
                               const Trajectory& trajectory, const ScanSensitivity& sensitivity);

 private:
  static constexpr std::size_t kAtATime = 32;
  /// A feature under the trajectory, and what it matches.
  struct Correspondence {
    const Feature* feature = nullptr;
    LocalMaps::PerLevel* cached = nullptr;  // its cells in the step before
    Eigen::Vector3f turned_m;               // in the odometry's axes, from the sensor
    Eigen::Vector3d point_m;                // in the odometry's frame
    CellMap::CellKey key;
    std::int32_t cell = CellMap::kNone;
    std::size_t level = 0;  // of the cell
    Match match;
  };
  /// Weights of structure by its height above the sensor.
  struct HeightWeights {
    float low = 1.0F, tall = 1.0F;
    bool is_slow = false;  // else both are 1
  };
  struct Sums {
    double weights = 0.0, squares = 0.0, structure = 0.0;
    double low = 0.0, tall = 0.0;  // information of structure
    TallEquations of_tall;
  };
  void weigh_by_height(const std::vector<Feature>& features, LocalMaps& maps, const Prior& prior,
                       Solution& solution);
  [[nodiscard]] float weight_by_height(const Feature& f) const;
  Sums accumulate(const std::vector<Feature>& features, std::size_t stride, LocalMaps& maps,
                  Levels levels, Solution& solution);
  std::size_t look_up(const std::vector<Feature>& features, std::size_t first, std::size_t stride);
  static void match(std::span<Correspondence> some, LocalMaps& maps, Levels levels, Sides sides);
  void add_beam_residual(const Correspondence& one, LocalMaps& maps,
                         const ScanSensitivity& sensitivity, BeamEquations& sums) const;
  void add_residual(const Correspondence& one, float kernel_scale, float data_weight, Sums& sums);
  Vector6d design_effect(const Unknowns& step, const Prior& prior) const;
  [[nodiscard]] Matrix6d data_information() const;
  [[nodiscard]] KnotEquations data_equations(const Prior& prior, const Unknowns& x,
                                             const DeadReckoning& reckoned) const;
  [[nodiscard]] GaussNewtonStep step_from(const Unknowns& x, const Prior& prior,
                                          const DeadReckoning& reckoned) const;

  SolverConfig config_;
  HeightWeights height_weights_;  // of the scan being solved
  Sides sides_ = Sides::seen;     // the same
  Sampled sampled_;
  std::array<ResidualSums, registration::kResidualInstants + 1> bins_;
  std::array<Correspondence, kAtATime> correspondences_;
  std::vector<LocalMaps::PerLevel> cached_cells_;
};

}  // namespace lilo::core
