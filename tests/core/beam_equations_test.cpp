// SPDX-License-Identifier: BSD-3-Clause
// What the estimates make of given equations.
#include "core/calibration/beam_calibration.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

namespace lilo::core {
namespace {

constexpr double kMrad = 1e-3;
constexpr int kCommon = 2;  // column of the common error

/// A calibration of 16 rings, of which ring k lies 15 - 2 k degrees below the horizon.
class Observed {
 public:
  explicit Observed(const BeamEstimate& kept = {}) {
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
  BeamEstimate kept;
  kept.ring_count = 16;
  kept.elevation_sigma_rad.fill(0.1 * kMrad);
  kept.common_elevation_rad = common_rad;
  kept.common_elevation_sigma_rad = 0.1 * kMrad;
  return kept;
}

TEST(BeamEquations, AnEccentricityIsAppliedBetweenThatOfAnExactEncoderAndTheLargest) {
  for (const auto& [cosine_mrad, applied_mrad] :
       {std::pair{0.35, 0.0}, {0.45, 0.45}, {2.9, 2.9}, {3.1, 0.0}}) {
    const BeamEstimate found = Observed().observe(equations_of(0, cosine_mrad * kMrad)).found();
    EXPECT_NEAR(found.eccentricity_rad[0], applied_mrad * kMrad, 0.01 * kMrad);
  }
}

TEST(BeamEquations, ACommonErrorIsAppliedFromOneAndAHalfSigmas) {
  // A weight of 0.16 and the prior give 1 sigma of 0.5 mrad, and 3/4 of the error.
  constexpr double kInformation = 3e6 / 0.16;
  for (const auto& [common_mrad, applied_mrad] : {std::pair{0.9, 0.0}, {1.2, 0.9}, {-1.2, -0.9}}) {
    const BeamEstimate found =
        Observed().observe(equations_of(kCommon, common_mrad * kMrad, kInformation)).found();
    EXPECT_NEAR(found.common_elevation_rad, applied_mrad * kMrad, 0.01 * kMrad);
    EXPECT_NEAR(found.common_elevation_sigma_rad, (applied_mrad == 0.0 ? 1.0 : 0.5) * kMrad,
                0.01 * kMrad);
  }
}

TEST(BeamEquations, ACommonErrorTooSmallOrTooLargeIsNotApplied) {
  for (const double common_rad : {0.4 * kMrad, 4.0 * kMrad}) {
    Observed observed(kept_common(common_rad));
    EXPECT_EQ(observed.found().common_elevation_rad, 0.0);
    observed.observe(equations_of(kCommon, common_rad));
    EXPECT_EQ(observed.found().common_elevation_rad, 0.0);
  }
}

TEST(BeamEquations, TheCommonErrorOfAnEarlierRunIsKept) {
  for (const double common_rad : {0.55 * kMrad, 1.1 * kMrad}) {
    Observed observed(kept_common(common_rad));
    EXPECT_EQ(observed.found().common_elevation_rad, common_rad);
    observed.observe({});  // it tells nothing
    EXPECT_NEAR(observed.found().common_elevation_rad, common_rad, 0.01 * kMrad);
    EXPECT_GE(observed.found().common_elevation_sigma_rad, 0.38 * kMrad) << "it is believed less";
  }
}

// The residuals are those of corrected beams: 0.2 mrad of 1 mrad are left.
TEST(BeamEquations, WhatWasAppliedIsAddedToWhatIsLeft) {
  BeamEquations scan = equations_of(kCommon, 0.2 * kMrad);
  scan.path.errors.information(kCommon, kBeamErrors) = 1e10 * 0.8 * kMrad;
  EXPECT_NEAR(Observed().observe(scan).found().common_elevation_rad, kMrad, 0.01 * kMrad);
}

// All that the scan tells of the common error is that of one ring.
TEST(BeamEquations, TheErrorOfOneRingIsNotTheCommonOne) {
  BeamEquations scan = equations_of(kCommon, kMrad);
  RingEquations& ring = scan.rings[3];
  ring.curvature = 1e10;
  ring.gradient = 1e10 * kMrad;
  ring.by_errors[kCommon] = 1e10;
  EXPECT_NEAR(Observed().observe(scan).found().common_elevation_rad, 0.0, 0.01 * kMrad);
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
  EXPECT_NEAR(covariance(5, 5), 2e5 * 2e5 / (0.16 * 4e10 + 1e6), 0.01) << "of the weight and prior";
  const auto large = observed.calibration.rebase();
  ASSERT_TRUE(large.has_value());
  EXPECT_NEAR(large->at(place_m)(2, kCommon), 2e5F, 1.0F);
  EXPECT_EQ(observed.calibration.sensitivity().pose.moved.norm(), 0.0F);
  EXPECT_EQ(observed.calibration.pose_covariance(), covariance) << "it is as uncertain";
  EXPECT_FALSE(observed.calibration.rebase().has_value());
}

// A pose that follows the common error by -1 m/rad is uncertain by 1 mrad of it: by 1 mm upwards.
TEST(BeamEquations, WhatIsNotKnownOfAnErrorMakesThePoseUncertain) {
  Observed observed;
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
  const BeamEstimate found = Observed().observe(scan).found();
  EXPECT_GT(found.elevation_rad[2] - found.elevation_rad[3], 1.5 * kMrad);
  EXPECT_EQ(found.elevation_rad[9], 0.0) << "it saw no ground";
  EXPECT_EQ(found.common_elevation_rad, 0.0);
}

}  // namespace
}  // namespace lilo::core
