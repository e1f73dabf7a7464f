// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/features.hpp"
#include "core/paper/range_image.hpp"
#include "core/paper/segmentation.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

namespace lilo::paper {
namespace {

using test::even_beams;
using test::still_scan_of;

const BeamTable k16 = even_beams(16, -15.0, 15.0);
const BeamTable k64 = even_beams(64, -24.8, 2.0);
constexpr int kHorizon16 = 8;

RangeImage projected(const Scan& scan, int columns = 720) {
  RangeImage image;
  project(scan, columns, 0.5, 100.0, image);
  return image;
}

TEST(Projection, EveryPixelHoldsItsNearestReturn) {
  const Scan scan = still_scan_of(test::yard(), k16, {});
  const RangeImage image = projected(scan);
  cv::Mat1f nearest(16, 720, 0.0F);
  for (const Return& r : scan.returns) {
    // Eq. 16 read backwards, by table instead of by formula: the column whose centre is closest.
    int best = 0;
    for (int j = 0; j < 720; ++j) {
      const auto off = [&](int column) {
        const double centre = std::numbers::pi - 2.0 * std::numbers::pi * column / 720.0;
        return std::abs(
            std::remainder(centre - static_cast<double>(r.azimuth_rad), 2.0 * std::numbers::pi));
      };
      if (off(j) < off(best) - 1e-6) best = j;
    }
    float& pixel = nearest(15 - r.ring, best);
    if (pixel == 0.0F || range_of(r) < pixel) pixel = range_of(r);
  }
  int different = 0;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 720; ++j) {
      if (std::abs(nearest(i, j) - image.range_m(i, j)) > 1e-4F) ++different;
    }
  }
  EXPECT_LE(different, 16 * 720 / 500);  // returns that lie on a border between two columns
}

TEST(Projection, ReconstructionGivesBackTheReturn) {
  const Scan scan = still_scan_of(test::yard(), k64, {});
  const RangeImage image = projected(scan, 1024);
  const cv::Mat1b all(image.range_m.size(), static_cast<uchar>(Label::surface));
  cv::Mat1b labels = all.clone();
  labels.setTo(static_cast<uchar>(Label::empty), image.range_m <= 0.0);
  const Features features = reconstruct(scan, image, labels);
  ASSERT_GT(features.surfaces->size(), 10000U);
  std::size_t n = 0;
  for (int i = 0; i < image.rows(); ++i) {
    for (int j = 0; j < image.columns(); ++j) {
      if (image.range_m(i, j) <= 0.0F) continue;
      const Return& r = scan.returns[static_cast<std::size_t>(image.at(i, j).first)];
      const Point& p = (*features.surfaces)[n++];
      ASSERT_EQ(p.getVector3fMap(), Eigen::Vector3f(r.x_m, r.y_m, r.z_m));
    }
  }
  EXPECT_EQ(n, features.surfaces->size());
}

TEST(Projection, LeavesOutWhatIsTooNearTooFarOrNoNumber) {
  Scan scan;
  scan.beams = k16;
  scan.returns = {{.x_m = 0.3F}, {.x_m = 150.0F}, {.x_m = std::nanf("")}};
  EXPECT_EQ(cv::countNonZero(projected(scan).range_m), 0);
}

TEST(Interpolation, KeepsToTheSurfaceAndNeverBridgesAJump) {
  const test::Scene scene = test::yard();
  const Scan scan = still_scan_of(scene, k16, {});
  const RangeImage image = projected(scan);
  RangeImage taller;
  interpolate_rows(image, 32, taller);
  ASSERT_EQ(taller.rows(), 32);
  cv::Mat1b labels(taller.range_m.size(), static_cast<uchar>(Label::surface));
  labels.setTo(static_cast<uchar>(Label::empty), taller.range_m <= 0.0);
  int made = 0;
  for (int i = 1; i < 32; i += 2) made += cv::countNonZero(taller.range_m.row(i));
  EXPECT_GT(made, 1000);
  // Every point, made or measured, lies on a wall, on the ground or on a pole. A chord across the
  // corner of ground and wall cuts half the beams' spacing deep: 35 cm at 20 m. A ghost between a
  // pole and the wall behind it would be metres off.
  const Features features = reconstruct(scan, taller, labels);
  for (const Point& p : *features.surfaces) {
    const Eigen::Vector3d q = p.getVector3fMap().cast<double>();
    double nearest = 1e9;
    for (const auto& plane : scene.planes) {
      nearest = std::min(nearest, std::abs(plane.normal.dot(q) - plane.offset_m));
    }
    for (const auto& pole : scene.poles) {
      nearest = std::min(nearest,
                         std::abs(std::hypot(q.x() - pole.x_m, q.y() - pole.y_m) - pole.radius_m));
    }
    EXPECT_LT(nearest, 0.35);
  }
}

TEST(Sobel, HasGainEightOnARampAndWrapsAround) {
  cv::Mat1f ramp(8, 36);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 36; ++j) ramp(i, j) = 10.0F + 0.25F * static_cast<float>(i);
  }
  EXPECT_NEAR(vertical_sobel(ramp)(4, 0), 8 * 0.25F, 1e-5F);  // column 0 has a left neighbour
  EXPECT_NEAR(horizontal_sobel(ramp)(4, 0), 0.0F, 1e-5F);
}

TEST(Segmentation, IsAPartition) {
  const Scan scan = still_scan_of(test::yard(), k64, {});
  const RangeImage image = projected(scan);
  for (const GroundFilter filter : {GroundFilter::sobel, GroundFilter::fourier}) {
    PaperConfig config;
    config.ground_filter = filter;
    const cv::Mat1b labels = segment(image.range_m, config, k64);
    const auto count = [&](Label l) { return cv::countNonZero(labels == static_cast<uchar>(l)); };
    const int filled = cv::countNonZero(image.range_m);
    EXPECT_EQ(count(Label::edge) + count(Label::surface) + count(Label::ground), filled);
    EXPECT_EQ(count(Label::empty), image.rows() * image.columns() - filled);
    for (const Label l : {Label::edge, Label::surface, Label::ground}) EXPECT_GT(count(l), 100);
    const Features f = reconstruct(scan, image, labels);
    EXPECT_EQ(f.edges->size() + f.surfaces->size() + f.ground->size(),
              static_cast<std::size_t>(filled));
  }
}

TEST(Fourier, RemovesAFlatSiteSeenBySixteenBeams) {
  test::Scene flat;
  flat.planes = {{{0.0, 0.0, 1.0}, -1.5}};
  const RangeImage image = projected(still_scan_of(flat, k16, {}));
  const cv::Mat1b ground = fourier_ground(image.range_m, kHorizon16, 0.15);
  EXPECT_EQ(cv::countNonZero(ground), cv::countNonZero(image.range_m));
}

TEST(Fourier, RemovesATiltedFlatSiteAsWell) {
  test::Scene flat;
  const Eigen::Vector3d up = Eigen::Vector3d(0.03, -0.02, 1.0).normalized();
  flat.planes = {{up, -1.5}};
  const RangeImage image = projected(still_scan_of(flat, k16, {}));
  const cv::Mat1b ground = fourier_ground(image.range_m.rowRange(10, 16), 0, 0.15);
  EXPECT_GT(cv::countNonZero(ground), 6 * 720 * 99 / 100);
}

TEST(Fourier, KeepsAWall) {
  test::Scene scene;
  scene.planes = {{{0.0, 0.0, 1.0}, -1.5}, {{-1.0, 0.0, 0.0}, -6.0}};
  const RangeImage image = projected(still_scan_of(scene, k16, {}));
  const cv::Mat1b ground = fourier_ground(image.range_m, kHorizon16, 0.15);
  int wall = 0, removed = 0;
  for (int i = kHorizon16; i < 16; ++i) {
    for (int j = 330; j < 390; ++j) {  // ahead, where the wall is nearer than the ground
      const double w = -(2.0 * (i - kHorizon16) + 1.0) * std::numbers::pi / 180.0;
      if (1.5 / std::sin(-w) * std::cos(w) < 8.0) continue;
      ++wall;
      removed += ground(i, j) != 0 ? 1 : 0;
    }
  }
  ASSERT_GT(wall, 100);
  EXPECT_LT(removed, wall / 20);
}

TEST(Sobel, TheOutlineOfAPoleIsAnEdge) {
  test::Scene scene;
  scene.poles = {{8.0, 0.0, 0.15, 30.0}};
  scene.planes = {{{-1.0, 0.0, 0.0}, -25.0}};
  const RangeImage image = projected(test::still_scan_of(scene, k64, {}));
  for (const bool drop_shadow_edges : {true, false}) {
    PaperConfig config;
    config.drop_shadow_edges = drop_shadow_edges;
    const cv::Mat1b labels = segment(image.range_m, config, k64);
    const auto is_pole = [&](int i, int j) { return image.range_m(i, j) < 12.0F; };
    const auto is_edge = [&](int i, int j) {
      return labels(i, j) == static_cast<uchar>(Label::edge);
    };
    int outline = 0, edges = 0, shadow_edges = 0;
    for (int i = 0; i < image.rows(); ++i) {
      for (int j = 350; j <= 370; ++j) {
        if (!is_pole(i, j) && is_edge(i, j)) ++shadow_edges;
        if (!is_pole(i, j) || (is_pole(i, j - 1) && is_pole(i, j + 1))) continue;
        ++outline;
        if (is_edge(i, j)) ++edges;
      }
    }
    ASSERT_GT(outline, 100);
    EXPECT_GT(edges, outline * 95 / 100);
    if (drop_shadow_edges) {
      EXPECT_EQ(shadow_edges, 0);
    } else {
      EXPECT_GT(shadow_edges, 0);
    }
  }
}

}  // namespace
}  // namespace lilo::paper
