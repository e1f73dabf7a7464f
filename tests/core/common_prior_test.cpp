// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/common_prior.hpp"

#include "core/constants.hpp"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace lilo::core {
namespace {

constexpr double kMrad = 1e-3, kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kShared_rad2 = calibration::kShared_rad * calibration::kShared_rad;

struct Sensor {
  std::vector<RingError> rings;
  double common_rad = 0.0;  ///< as its ground does not show it
};

/// A sensor whose rings at -3, -5 ... -17 degrees err independently. Its ground shows the errors
/// but for two parts that a fit over the rings subtracts, weighted by the squared range.
Sensor sensor_of(double sigma_rad, std::mt19937& random) {
  std::normal_distribution<double> error_rad(0.0, sigma_rad);
  Eigen::Matrix<double, 8, 2> parts;
  Eigen::Matrix<double, 8, 1> errors_rad, root_of_weight;
  Sensor sensor;
  for (int k = 0; k < 8; ++k) {
    const double elevation_rad = -kRadPerDeg * (3.0 + 2.0 * k);
    parts.row(k) << 5.0 * kRadPerDeg / -elevation_rad, elevation_rad;
    errors_rad[k] = error_rad(random);
    root_of_weight[k] = 1.0 / -elevation_rad;
    sensor.rings.push_back({elevation_rad, 0.0, 1.0});
  }
  const Eigen::Vector2d fitted = (root_of_weight.asDiagonal() * parts)
                                     .colPivHouseholderQr()
                                     .solve(root_of_weight.cwiseProduct(errors_rad));
  const Eigen::Matrix<double, 8, 1> shown_rad = errors_rad - parts * fitted;
  for (int k = 0; k < 8; ++k) sensor.rings[static_cast<std::size_t>(k)].found_rad = shown_rad[k];
  sensor.common_rad = fitted[0];
  return sensor;
}

// Eight rings less two parts leave six degrees of freedom. The mean square of a Student
// distribution with six, in units of its own variance, is one.
TEST(CommonPrior, IsAsFarOffAsItsVarianceSays) {
  constexpr int kSensors = 20000;
  std::mt19937 random(5);
  double by_mean = 0.0, by_variance = 0.0, squares = 0.0;
  for (int k = 0; k < kSensors; ++k) {
    const Sensor sensor = sensor_of(kMrad, random);
    const CommonPrior prior = common_prior(sensor.rings);
    ASSERT_TRUE(prior.is_known);
    const double off_rad = sensor.common_rad - prior.mean_rad;
    by_variance += off_rad * off_rad / (prior.variance_rad2 - kShared_rad2) / kSensors;
    by_mean += off_rad * off_rad / kSensors;
    squares += sensor.common_rad * sensor.common_rad / kSensors;
  }
  EXPECT_NEAR(by_variance, 1.0, 0.1);
  EXPECT_LT(by_mean, 0.95 * squares) << "the mean tells something";
}

TEST(CommonPrior, IsAsWideAsTheErrorsAreLarge) {
  std::mt19937 one(7), same(7);
  const CommonPrior exact = common_prior(sensor_of(0.01 * kMrad, one).rings);
  const CommonPrior wrong = common_prior(sensor_of(kMrad, same).rings);
  EXPECT_NEAR(wrong.mean_rad / exact.mean_rad, 100.0, 1.0);
  EXPECT_NEAR((wrong.variance_rad2 - kShared_rad2) / (exact.variance_rad2 - kShared_rad2), 1e4,
              200.0);
}

TEST(CommonPrior, OfExactRingsIsWhatAllMayShare) {
  std::mt19937 random(1);
  const CommonPrior prior = common_prior(sensor_of(0.0, random).rings);
  EXPECT_TRUE(prior.is_known);
  EXPECT_EQ(prior.mean_rad, 0.0);
  EXPECT_DOUBLE_EQ(prior.variance_rad2, kShared_rad2);
}

// Rings that are resumed from an earlier run are known to 0.84.
TEST(CommonPrior, IsKnownFromSixRings) {
  for (const double known_part : {0.84, 0.99}) {
    std::mt19937 random(1);
    std::vector<RingError> rings = sensor_of(kMrad, random).rings;
    for (RingError& ring : rings) ring.known_part = known_part;
    rings.resize(6);
    EXPECT_TRUE(common_prior(rings).is_known);
    rings.resize(5);
    const CommonPrior unknown = common_prior(rings);
    EXPECT_FALSE(unknown.is_known);
    EXPECT_EQ(unknown.mean_rad, 0.0);
    EXPECT_DOUBLE_EQ(unknown.variance_rad2, kMrad * kMrad);
  }
}

TEST(CommonPrior, IsNotKnownFromRingsThatDoNotShowIt) {
  std::vector<RingError> rings(8, RingError{-0.1, 0.5 * kMrad, 1.0});
  EXPECT_FALSE(common_prior(rings).is_known) << "all look the same way";
  for (std::size_t k = 0; k < rings.size(); ++k) rings[k].elevation_rad = 0.05 * double(k + 1);
  EXPECT_FALSE(common_prior(rings).is_known) << "all look at a ceiling";
}

// Of a ring that has hardly seen the ground a hundredth of its error is found.
TEST(CommonPrior, HardlyDependsOnRingsThatHardlySawTheGround) {
  std::mt19937 random(3);
  std::vector<RingError> rings = sensor_of(kMrad, random).rings;
  const CommonPrior without = common_prior(rings);
  rings.push_back({-2.0 * kRadPerDeg, 0.01 * 1.5 * kMrad, 0.01});
  const CommonPrior with = common_prior(rings);
  EXPECT_NEAR(with.mean_rad, without.mean_rad, 0.02 * kMrad);
  EXPECT_NEAR(with.variance_rad2 / without.variance_rad2, 1.0, 0.05);
}

TEST(Widened, IsTheSameWhereThePathAgrees) {
  const CommonPrior prior{true, 0.2 * kMrad, 0.09 * kMrad * kMrad};  // 0.3 mrad
  // 0.5 mrad is one sigma of 0.3 and 0.4 mrad together.
  const CommonPrior same = widened(prior, 0.69 * kMrad, 0.16 * kMrad * kMrad);
  EXPECT_EQ(same.mean_rad, prior.mean_rad);
  EXPECT_EQ(same.variance_rad2, prior.variance_rad2);
}

TEST(Widened, PutsThePathAtOneSigma) {
  const CommonPrior prior{true, 0.2 * kMrad, 0.09 * kMrad * kMrad};
  for (const double seen_rad : {-0.8 * kMrad, 1.2 * kMrad}) {
    const CommonPrior wide = widened(prior, seen_rad, 0.16 * kMrad * kMrad);
    EXPECT_TRUE(wide.is_known);
    EXPECT_EQ(wide.mean_rad, prior.mean_rad);
    EXPECT_NEAR(wide.variance_rad2 + 0.16 * kMrad * kMrad, kMrad * kMrad, 1e-12);
  }
}

// A path that is as uncertain as 10 mrad tells nothing.
TEST(Widened, IsNoWiderThanWhereNoRingIsKnown) {
  const CommonPrior wide = widened({true, 0.0, 0.09 * kMrad * kMrad}, 11.0 * kMrad, 1e-4);
  EXPECT_DOUBLE_EQ(wide.variance_rad2, CommonPrior{}.variance_rad2);
}

}  // namespace
}  // namespace lilo::core
