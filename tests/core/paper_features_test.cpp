// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/features.hpp"
#include "core/paper/local_map.hpp"
#include "core/paper/segmentation.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lilo::paper {
namespace {

constexpr double kPi = std::numbers::pi;
const BeamTable k16 = test::even_beams(16, -15.0, 15.0);
const BeamTable k64 = test::even_beams(64, -24.8, 2.0);

cv::Mat1b surfaces_everywhere(const RangeImage& image) {
  cv::Mat1b labels(image.range_m.size(), static_cast<uchar>(Label::surface));
  labels.setTo(static_cast<uchar>(Label::empty), image.range_m <= 0.0);
  return labels;
}

/// Eqs. 14-16 invert Eqs. 2-5 up to half a column: the chord of an angle of pi / N.
TEST(Reconstruction, PixelCentresAreWithinHalfAColumnOfTheReturn) {
  const Scan scan = test::still_scan_of(test::yard(), k64, {});
  for (const int columns : {360, 720, 1024}) {
    RangeImage image;
    project(scan, columns, 0.5, 100.0, image);
    const cv::Mat1b labels = surfaces_everywhere(image);
    const Cloud centres = *reconstruct(scan, image, labels, true).surfaces;
    const Cloud returns = *reconstruct(scan, image, labels, false).surfaces;
    ASSERT_EQ(centres.size(), returns.size());
    ASSERT_GT(centres.size(), 10000U);
    double worst = 0.0;
    for (std::size_t k = 0; k < centres.size(); ++k) {
      const Eigen::Vector3d centre = centres[k].getVector3fMap().cast<double>();
      const Eigen::Vector3d at = returns[k].getVector3fMap().cast<double>();
      const double half_column_m = 2.0 * std::hypot(at.x(), at.y()) * std::sin(0.5 * kPi / columns);
      ASSERT_LE((centre - at).norm(), half_column_m + 1e-4);
      ASSERT_NEAR(centre.z(), at.z(), 1e-6);
      ASSERT_NEAR(centre.norm(), at.norm(), 1e-4);
      const double column = (kPi - std::atan2(centre.y(), centre.x())) * columns / (2.0 * kPi);
      ASSERT_NEAR(column, std::round(column), 1e-3);
      worst = std::max(worst, (centre - at).norm() / half_column_m);
    }
    if (columns != 360) continue;  // 1800 firings: five a column, the outermost at 0.8 of its half
    EXPECT_GT(worst, 0.7);
  }
}

/// The sensor drives and turns at constant speed; every point must come to where it would have been
/// seen from at the end, to half of the 64 slices' share of the motion.
TEST(Deskewing, TakesOutAKnownMotion) {
  const Eigen::Vector2d v(2.0, -0.5);
  constexpr double kYaw_rad = 0.1;
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> away(-30.0, 30.0);
  std::uniform_real_distribution<float> when(0.0F, 1.0F);
  Cloud raw;
  std::vector<Eigen::Vector3d> expected;
  for (int k = 0; k < 500; ++k) {
    const Eigen::Vector3d at(away(rng), away(rng), 0.1 * away(rng));  // where it stands
    const float s = when(rng);
    const auto seen = [&](double part) -> Eigen::Vector3d {
      const double c = std::cos(part * kYaw_rad), n = std::sin(part * kYaw_rad);
      const double x = at.x() - part * v.x(), y = at.y() - part * v.y();
      return {c * x + n * y, c * y - n * x, at.z()};
    };
    Point p;
    p.getVector3fMap() = seen(static_cast<double>(s)).cast<float>();
    p.intensity = s;
    raw.push_back(p);
    expected.push_back(seen(1.0));
  }
  const Pose T_start_end{so3_exp({0.0, 0.0, kYaw_rad}), {v.x(), v.y(), 0.0}};
  Cloud deskewed;
  deskew(T_start_end, raw, deskewed);
  ASSERT_EQ(deskewed.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double bound_m = (v.norm() + kYaw_rad * (expected[k].norm() + v.norm())) / 128.0 + 1e-4;
    EXPECT_LE((deskewed[k].getVector3fMap().cast<double>() - expected[k]).norm(), bound_m);
  }
}

/// I_E + I_G + I_S = I (Eqs. 8-10), whatever the image: random ranges with holes.
TEST(Segmentation, ClassesAddUpToTheImage) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> range(1.0F, 40.0F);
  std::bernoulli_distribution hole(0.2);
  for (int n = 0; n < 20; ++n) {
    cv::Mat1f image(16, 90);
    for (float& r : image) r = hole(rng) ? 0.0F : range(rng);
    PaperConfig config;
    config.ground_filter = n % 2 == 0 ? GroundFilter::sobel : GroundFilter::fourier;
    config.drop_shadow_edges = n % 3 == 0;
    const cv::Mat1b labels = segment(image, config, k16);
    cv::Mat1f sum(image.size(), 0.0F);
    for (const Label label : {Label::edge, Label::surface, Label::ground}) {
      cv::Mat1f part(image.size(), 0.0F);
      image.copyTo(part, labels == static_cast<uchar>(label));
      sum += part;
    }
    EXPECT_EQ(cv::countNonZero(sum != image), 0);
  }
}

TEST(Segmentation, GroundLiesBelowTheHorizonAndItsFilterGoesWithTheSensor) {
  EXPECT_EQ(first_ground_row(k16, 16), 8);
  EXPECT_EQ(first_ground_row(k16, 32), 16);
  EXPECT_EQ(first_ground_row(test::even_beams(4, -30.0, -5.0), 4), 0);
  PaperConfig config;
  EXPECT_EQ(ground_filter_for(config, 16), GroundFilter::fourier);
  EXPECT_EQ(ground_filter_for(config, 64), GroundFilter::sobel);
  config.ground_filter = GroundFilter::sobel;
  EXPECT_EQ(ground_filter_for(config, 16), GroundFilter::sobel);
}

TEST(RangeImage, OnlySensorsOfFewBeamsAreInterpolated) {
  OdometryConfig config;
  EXPECT_EQ(image_of(test::still_scan_of(test::yard(), k16, {}), config).rows(), 32);
  EXPECT_EQ(image_of(test::still_scan_of(test::yard(), k64, {}), config).rows(), 64);
  config.paper.interpolated_rows = 0;
  EXPECT_EQ(image_of(test::still_scan_of(test::yard(), k16, {}), config).rows(), 16);
}

Cloud points_at(const std::vector<Eigen::Vector3f>& places) {
  Cloud cloud;
  for (const Eigen::Vector3f& place : places) {
    cloud.push_back({});
    cloud.back().getVector3fMap() = place;
  }
  return cloud;
}

TEST(LocalMap, KeepsOneCentroidAVoxelAndForgetsWhatIsFarAlongAnyAxis) {
  LocalMap map(0.4, 100.0);
  const Cloud near = points_at({{0.05F, 0.05F, 0.05F}, {0.15F, 0.05F, 0.05F}, {5.0F, 5.0F, 5.0F}});
  map.update({&near}, {});
  ASSERT_EQ(map.cloud().size(), 2U);
  Point origin;
  origin.getVector3fMap() = Eigen::Vector3f(0.0F, 0.05F, 0.05F);
  const std::vector<int> found = map.neighbours(origin, 1.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(map.cloud()[static_cast<std::size_t>(found[0])].x, 0.1F, 1e-6F);  // of 0.05 and 0.15
  EXPECT_EQ(map.neighbours(origin, 20.0).size(), 2U);

  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    LocalMap there = map;
    const Cloud none;
    there.update({&none}, {Eigen::Quaterniond::Identity(), 99.0 * along});
    EXPECT_EQ(there.cloud().size(), 2U) << axis;
    there.update({&none}, {Eigen::Quaterniond::Identity(), 102.0 * along});
    EXPECT_EQ(there.cloud().size(), 1U) << axis;  // the one at 5 m is left
  }
}

}  // namespace
}  // namespace lilo::paper
