// SPDX-License-Identifier: BSD-3-Clause
// What the estimates make of given equations.
#include "core/calibration/beam_calibration.hpp"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace lilo::core {
namespace {

constexpr double kMrad = 1e-3;
constexpr int kCommon = 2;  // column of the common error

/// Of the eight rings below the horizon, which are off by 0.9 mrad (rms). Neither part that the
/// ground does not show is in their errors, so they let expect no common error.
BeamEstimate kept_rings() {
  Eigen::Matrix<double, 8, 2> parts;
  Eigen::Matrix<double, 8, 1> errors_rad;
  for (int ring = 0; ring < 8; ++ring) {
    const double elevation_deg = 2.0 * ring - 15.0;  // the common error is limited at 2 degrees
    parts.row(ring) << 5.0 / std::max(-elevation_deg, 2.0), elevation_deg;
    errors_rad[ring] = ring % 2 == 0 ? kMrad : -kMrad;
  }
  errors_rad -= parts * parts.colPivHouseholderQr().solve(errors_rad);
  BeamEstimate kept;
  kept.ring_count = 16;
  kept.elevation_sigma_rad.fill(kMrad);
  kept.eccentricity_sigma_rad = kept.common_elevation_sigma_rad = kMrad;
  for (std::size_t ring = 0; ring < 8; ++ring) {
    kept.elevation_rad[ring] = errors_rad[static_cast<Eigen::Index>(ring)];
    kept.elevation_sigma_rad[ring] = 0.1 * kMrad;
  }
  return kept;
}

/// A calibration of 16 rings, of which ring k lies 15 - 2 k degrees below the horizon.
class Observed {
 public:
  explicit Observed(const BeamEstimate& kept = kept_rings()) {
    beams_.ring_count = 16;
    for (std::size_t ring = 0; ring < 16; ++ring) {
      beams_.elevation_rad[ring] = 0.01745F * (2.0F * static_cast<float>(ring) - 15.0F);
    }
    calibration.resume(kept);
    calibration.begin_scan(beams_);
  }
  Observed& observe(const BeamEquations& scan, const Eigen::Vector3d& place_m = {0.0, 0.0, 0.0}) {
    calibration.observe(scan, beams_, place_m);
    return *this;
  }
  BeamEstimate found() const { return calibration.estimate(); }

  BeamCalibration calibration;

 private:
  BeamTable beams_;
};

/// A scan that tells all errors with this information, and that one of them is so large.
BeamEquations equations_of(int error, double error_rad, double information = 1e10) {
  BeamEquations scan;
  scan.path.errors.information.diagonal().setConstant(information);
  scan.path.errors.gradient[error] = information * error_rad;
  return scan;
}

BeamEstimate kept_common(double common_rad) {
  BeamEstimate kept = kept_rings();
  kept.common_elevation_rad = kept.common_by_path_rad = common_rad;
  kept.common_elevation_sigma_rad = kept.common_by_path_sigma_rad = 0.1 * kMrad;
  return kept;
}

TEST(BeamEquations, AnEccentricityIsAppliedBetweenThatOfAnExactEncoderAndTheLargest) {
  for (const auto& [cosine_mrad, applied_mrad] :
       {std::pair{0.35, 0.0}, {0.45, 0.45}, {2.9, 2.9}, {3.1, 0.0}}) {
    const BeamEstimate found = Observed().observe(equations_of(0, cosine_mrad * kMrad)).found();
    EXPECT_NEAR(found.eccentricity_rad[0], applied_mrad * kMrad, 0.01 * kMrad);
  }
}

TEST(BeamEquations, ACommonErrorIsNotAppliedBeforeTheRingsAreKnown) {
  BeamEstimate kept = kept_rings();
  for (const auto& [known_rings, applied_rad] : {std::pair{4, 0.0}, {8, kMrad}}) {
    for (int ring = known_rings; ring < 8; ++ring) {
      kept.elevation_rad[static_cast<std::size_t>(ring)] = 0.0;
      kept.elevation_sigma_rad[static_cast<std::size_t>(ring)] = kMrad;
    }
    const BeamEstimate found = Observed(kept).observe(equations_of(kCommon, kMrad)).found();
    EXPECT_NEAR(found.common_elevation_rad, applied_rad, 0.01 * kMrad) << known_rings;
    kept = kept_rings();
  }
}

// The path tells as little as 1 mrad.
TEST(BeamEquations, TheSmallerTheErrorsOfTheRingsTheSmallerTheCommonOne) {
  constexpr double kInformation = 1e6 / 0.16;
  double smaller_rad = 0.0;
  for (const double size : {0.01, 0.5, 1.0}) {
    BeamEstimate kept = kept_rings();
    for (double& error_rad : kept.elevation_rad) error_rad *= size;
    const BeamEstimate found =
        Observed(kept).observe(equations_of(kCommon, kMrad, kInformation)).found();
    EXPECT_GT(found.common_elevation_rad, 2.0 * smaller_rad);
    EXPECT_LT(found.common_elevation_rad, (0.05 + 0.3 * size) * kMrad);
    smaller_rad = found.common_elevation_rad;
  }
}

TEST(BeamEquations, ACommonErrorThatThePathIsSureOfIsFoundThoughTheRingsAgree) {
  BeamEstimate kept = kept_rings();
  kept.elevation_rad.fill(0.0);
  const BeamEstimate found =
      Observed(kept).observe(equations_of(kCommon, 2.0 * kMrad, 1e9)).found();
  EXPECT_NEAR(found.common_elevation_rad, 2.0 * kMrad, 0.1 * kMrad);
}

TEST(BeamEquations, ACommonErrorTooLargeIsNotApplied) {
  Observed observed(kept_common(4.0 * kMrad));
  EXPECT_EQ(observed.found().common_elevation_rad, 0.0);
  observed.observe(equations_of(kCommon, 4.0 * kMrad));
  EXPECT_EQ(observed.found().common_elevation_rad, 0.0);
}

TEST(BeamEquations, TheCommonErrorOfAnEarlierRunIsKept) {
  for (const double common_rad : {0.2 * kMrad, 0.7 * kMrad}) {
    Observed observed(kept_common(common_rad));
    EXPECT_EQ(observed.found().common_elevation_rad, common_rad);
    observed.observe({});  // it tells nothing
    EXPECT_GT(observed.found().common_elevation_rad, 0.6 * common_rad);
    EXPECT_NEAR(observed.found().common_by_path_rad, common_rad, 0.01 * kMrad);
    EXPECT_NEAR(observed.found().common_by_path_sigma_rad, 0.4 * kMrad, 0.01 * kMrad)
        << "it is believed less";
  }
}

// What the rings let expect counts once, and not with each run.
TEST(BeamEquations, TheCommonErrorIsTheSameAfterManyRuns) {
  const double information = 1.0 / (0.5 * kMrad * 0.5 * kMrad) / 0.16;
  for (const double size : {0.1, 1.0}) {  // of the rings' errors
    BeamEstimate kept = kept_rings();
    for (double& error_rad : kept.elevation_rad) error_rad *= size;
    const BeamEstimate first =
        Observed(kept).observe(equations_of(kCommon, 0.7 * kMrad, information)).found();
    ASSERT_GT(first.common_elevation_rad, 0.2 * kMrad);
    BeamEstimate last = first;
    for (int run = 0; run < 5; ++run) last = Observed(last).observe({}).found();
    EXPECT_NEAR(last.common_elevation_rad, first.common_elevation_rad, 0.02 * kMrad);
    EXPECT_NEAR(last.common_elevation_sigma_rad, first.common_elevation_sigma_rad, 0.02 * kMrad);
  }
}

TEST(BeamEquations, WhatWasNotAppliedIsNoEvidenceForZero) {
  BeamEstimate unknown;  // no ring has seen the ground
  unknown.ring_count = 16;
  unknown.elevation_sigma_rad.fill(kMrad);
  const BeamEstimate found = Observed(unknown).observe(equations_of(kCommon, 1.5 * kMrad)).found();
  EXPECT_EQ(found.common_elevation_rad, 0.0);
  EXPECT_DOUBLE_EQ(found.common_elevation_sigma_rad, kMrad);
  EXPECT_NEAR(found.common_by_path_rad, 1.5 * kMrad, 0.01 * kMrad);
  BeamEstimate kept = kept_rings();
  kept.common_by_path_rad = found.common_by_path_rad;
  kept.common_by_path_sigma_rad = found.common_by_path_sigma_rad;
  EXPECT_GT(Observed(kept).observe({}).found().common_elevation_rad, kMrad);
}

// A path as uncertain as 1 mrad shows 1.5 mrad.
TEST(BeamEquations, AnUncertainPathHardlyOutweighsRingsThatAgree) {
  BeamEstimate kept = kept_rings();
  kept.elevation_rad.fill(0.0);
  const BeamEstimate found =
      Observed(kept).observe(equations_of(kCommon, 1.5 * kMrad, 1e6 / 0.16)).found();
  EXPECT_LT(found.common_elevation_rad, 0.8 * kMrad);
}

TEST(BeamEquations, WhatAnEarlierRunFoundStaysUntilTheRingsAreKnown) {
  BeamEstimate kept = kept_common(0.7 * kMrad);
  kept.elevation_sigma_rad.fill(kMrad);
  EXPECT_EQ(Observed(kept).observe({}).found().common_elevation_rad, 0.7 * kMrad);
}

// The residuals are those of corrected beams: 0.2 mrad of 1 mrad are left.
TEST(BeamEquations, WhatWasAppliedIsAddedToWhatIsLeft) {
  BeamEquations scan = equations_of(kCommon, 0.2 * kMrad);
  scan.path.errors.information(kCommon, kBeamErrors) = 1e10 * 0.8 * kMrad;
  EXPECT_NEAR(Observed().observe(scan).found().common_elevation_rad, kMrad, 0.01 * kMrad);
}

// All that the scan tells of the common error is that of one ring, so it is the ring's or the
// common one. The ring may be off by 1 mrad: the path tells as little of the common error.
TEST(BeamEquations, TheErrorOfOneRingIsNotTheCommonOne) {
  BeamEquations scan;
  RingEquations& ring = scan.rings[3];
  ring.information = ring.curvature = 1e10;
  ring.gradient = 1e10 * kMrad;
  const double without_rad = Observed().observe(scan).found().common_elevation_rad;
  scan.path = equations_of(kCommon, kMrad).path;
  EXPECT_NEAR(Observed().observe(scan).found().common_elevation_rad, kMrad, 0.01 * kMrad);
  ring.by_errors[kCommon] = 1e10;
  const BeamEstimate found = Observed().observe(scan).found();
  EXPECT_NEAR(found.common_by_path_sigma_rad, kMrad, 0.02 * kMrad);
  EXPECT_NEAR(found.common_elevation_rad, without_rad, 0.35 * (kMrad - without_rad));
}

// A pose that is free to follow the error tells nothing of it.
TEST(BeamEquations, WhatThePoseCanFollowIsNoError) {
  BeamEquations scan = equations_of(kCommon, kMrad);
  scan.path.pose_information = 1e10 * Matrix6d::Identity();
  scan.path.cross_information(5, kCommon) = 1e10;
  scan.path.pose_gradient[5] = 1e10 * kMrad;
  const Observed observed = Observed().observe(scan);
  EXPECT_NEAR(observed.found().common_elevation_rad, 0.0, 0.01 * kMrad);
  EXPECT_NEAR(observed.calibration.sensitivity().pose.moved(5, kCommon), -1.0F, 1e-3);
}

TEST(BeamEquations, NothingThatIsNotFiniteIsObserved) {
  BeamEquations scan = equations_of(kCommon, kMrad);
  scan.path.errors.gradient[0] = std::numeric_limits<double>::quiet_NaN();
  Observed observed;
  observed.observe(scan).observe(equations_of(kCommon, kMrad));
  EXPECT_NEAR(observed.found().common_elevation_rad, kMrad, 0.01 * kMrad);
}

// The pose follows a common error by 2e5 m/rad.
TEST(BeamEquations, ALargeSensitivityIsGivenToBeSubtracted) {
  Observed observed;
  EXPECT_FALSE(observed.calibration.rebase().has_value());
  BeamEquations scan;
  scan.path.pose_information = 1e9 * Matrix6d::Identity();
  scan.path.cross_information(5, kCommon) = -2e14;
  scan.path.errors.information(kCommon, kCommon) = 4e19;  // 4e10 when the pose has followed
  const Eigen::Vector3d place_m(1.0, 2.0, 3.0);
  observed.observe(scan, place_m);
  const Matrix6d covariance = observed.calibration.pose_covariance();
  EXPECT_NEAR(covariance(5, 5), 2e5 * 2e5 / (0.16 * 4e10 + 2.5e6), 0.01)
      << "of the weight and prior";
  const auto large = observed.calibration.rebase();
  ASSERT_TRUE(large.has_value());
  EXPECT_NEAR(large->at(place_m)(2, kCommon), 2e5F, 1.0F);
  EXPECT_EQ(observed.calibration.sensitivity().pose.moved.norm(), 0.0F);
  EXPECT_EQ(observed.calibration.pose_covariance(), covariance) << "it is as uncertain";
  EXPECT_FALSE(observed.calibration.rebase().has_value());
}

// A pose that follows the common error by -1 m/rad is uncertain by 1 mrad of it: by 1 mm upwards.
TEST(BeamEquations, WhatIsNotKnownOfAnErrorMakesThePoseUncertain) {
  Observed observed{BeamEstimate{}};
  EXPECT_EQ(observed.calibration.pose_covariance().norm(), 0.0);
  BeamEquations scan;
  scan.path.pose_information = 1e10 * Matrix6d::Identity();
  scan.path.errors.information(kCommon, kCommon) = scan.path.cross_information(5, kCommon) = 1e10;
  observed.observe(scan);
  const Matrix6d covariance = observed.calibration.pose_covariance();
  EXPECT_NEAR(covariance(5, 5), 1e-6, 1e-9);
  EXPECT_NEAR(covariance.norm(), 1e-6, 1e-9) << "nothing else follows";
}

// The pose has followed 2 mrad that nothing corrected when they were found.
TEST(BeamEquations, WhatIsCorrectedLateMakesThePoseUncertain) {
  Observed observed;
  BeamEquations scan;
  scan.path.pose_information = 1e10 * Matrix6d::Identity();
  scan.path.errors.information(kCommon, kCommon) = scan.path.cross_information(5, kCommon) = 1e10;
  observed.observe(scan).observe(equations_of(kCommon, 2.0 * kMrad));
  EXPECT_NEAR(observed.calibration.pose_covariance()(5, 5), 4e-6, 1e-8);
}

// A ring's own mean follows its residual; what 1/elevation and elevation explain is taken out.
TEST(BeamEquations, ARingIsTakenForItsOwnError) {
  BeamEquations scan;
  for (std::size_t ring = 0; ring < 6; ++ring) {
    scan.rings[ring].information = 1e10;
    scan.rings[ring].gradient = 1e10 * (ring % 2 == 0 ? kMrad : -kMrad);
  }
  const BeamEstimate found = Observed(BeamEstimate{}).observe(scan).found();
  EXPECT_GT(found.elevation_rad[2] - found.elevation_rad[3], 1.5 * kMrad);
  EXPECT_EQ(found.elevation_rad[9], 0.0) << "it saw no ground";
  EXPECT_NEAR(found.common_elevation_rad, 0.0, 0.01 * kMrad);
}

}  // namespace
}  // namespace lilo::core
