// SPDX-License-Identifier: BSD-3-Clause
#include "config/odometry_keys.hpp"

#include "config/key_builders.hpp"

namespace lilo {
namespace {

using key_builders::angle;
using key_builders::boolean;
using key_builders::choice;
using key_builders::integer;
using key_builders::real;

constexpr Reload kRestart = Reload::restart;

}  // namespace

std::vector<Key> odometry_keys() {
  return {
      choice(
          "odometry.profile", LILO_MEMBER(odometry.profile), {"default", "paper"}, kRestart,
          "Which odometry runs; default: the fast and accurate one; paper: the method of the LiLO "
          "paper, for comparison."),
      real("odometry.min_range_m", LILO_MEMBER(odometry.min_range_m), 0.0, 20.0, "m", kRestart,
           "Nearer returns are not used for odometry."),
      real("odometry.max_range_m", LILO_MEMBER(odometry.max_range_m), 5.0, 300.0, "m", kRestart,
           "Farther returns are not used for odometry."),
  };
}

std::vector<Key> default_profile_keys() {
  return {
      integer("odometry.default.columns", LILO_MEMBER(odometry.default_profile.columns), 90, 4096,
              "", kRestart, "Width of the range image. An HDL-64E's is 576 wide at most."),
      integer(
          "odometry.default.ground_features", LILO_MEMBER(odometry.default_profile.ground_features),
          100, 20000, "", kRestart,
          "Ground points a scan is aligned by, about so many. More is more accurate and slower."),
      integer("odometry.default.structure_features",
              LILO_MEMBER(odometry.default_profile.structure_features), 100, 20000, "", kRestart,
              "The same for everything that stands."),
      integer("odometry.default.map_features", LILO_MEMBER(odometry.default_profile.map_features),
              500, 200000, "", kRestart, "Points a keyframe adds to the map, at most."),
      integer(
          "odometry.default.map_cells", LILO_MEMBER(odometry.default_profile.map_cells), 10000,
          2000000, "", kRestart,
          "Cells of ground, and as many of structure, the map can hold: this bounds the memory. "
          "Where three quarters are used, nearer parts are forgotten as well."),
      real("odometry.default.map_radius_m", LILO_MEMBER(odometry.default_profile.map_radius_m),
           20.0, 300.0, "m", kRestart, "Farther parts of the map are forgotten."),
      real("odometry.default.cell_m", LILO_MEMBER(odometry.default_profile.cell_m), 0.1, 2.0, "m",
           kRestart,
           "Size of a map cell; a surface is fitted over three of them. Smaller indoors, with a "
           "smaller map_radius_m."),
      real("odometry.default.keyframe_m", LILO_MEMBER(odometry.default_profile.keyframe_m), 0.01,
           10.0, "m", kRestart,
           "The map grows when the sensor has moved so far since it last grew. In rooms, and the "
           "first five times, 0.35 of that is enough."),
      angle("odometry.default.keyframe_deg", LILO_MEMBER(odometry.default_profile.keyframe_rad),
            0.1, 45.0, kRestart, "It also grows when the sensor has turned so far."),
      real("odometry.default.noise_m", LILO_MEMBER(odometry.default_profile.noise_m), 0.001, 0.2,
           "m", kRestart, "Range noise of the sensor, 1 sigma."),
      boolean("odometry.default.calibrate_beams",
              LILO_MEMBER(odometry.default_profile.calibrate_beams), kRestart,
              "Estimate, while driving, errors that the sensor's calibration does not know: of the "
              "rings' elevations, and the eccentricity of the encoder."),
      real("odometry.default.roll_pitch_density",
           LILO_MEMBER(odometry.default_profile.roll_pitch_density), 0.0001, 100.0, "", kRestart,
           "Least process noise of roll and pitch: power density of the angular acceleration "
           "(rad2/s3). More is estimated on the way. The least for the pose that is sent is a "
           "tenth."),
      real("odometry.default.yaw_density", LILO_MEMBER(odometry.default_profile.yaw_density),
           0.0001, 100.0, "", kRestart, "Least process noise of yaw, likewise (rad2/s3)."),
      real("odometry.default.translation_density",
           LILO_MEMBER(odometry.default_profile.translation_density), 0.001, 1000.0, "", kRestart,
           "Least process noise of the velocity (m2/s3). More is estimated on the way."),
  };
}

std::vector<Key> paper_keys() {
  return {
      integer("odometry.paper.columns", LILO_MEMBER(odometry.paper.columns), 90, 4096, "", kRestart,
              "Width of the range image; the paper has 360, 720 and 1024."),
      integer("odometry.paper.interpolated_rows", LILO_MEMBER(odometry.paper.interpolated_rows), 0,
              128, "", kRestart,
              "Height of the image that a sensor with fewer beams is interpolated to, 32 in the "
              "paper; 0: one row a beam."),
      choice(
          "odometry.paper.ground_filter", LILO_MEMBER(odometry.paper.ground_filter),
          {"by_sensor", "sobel", "fourier"}, kRestart,
          "How ground is told from the rest: sobel, large steps from ring to ring; fourier, rows "
          "that hardly vary along azimuth; by_sensor, as in the paper: fourier up to 16 beams, "
          "sobel "
          "above."),
      choice("odometry.paper.group", LILO_MEMBER(odometry.paper.group), {"EG", "ES", "EGS"},
             kRestart,
             "The features that align a scan: edges with ground, with surfaces, or with both."),
      choice("odometry.paper.deskew", LILO_MEMBER(odometry.paper.deskew),
             {"none", "one_stage", "two_stage"}, kRestart,
             "How the sensor's motion within a scan is taken out: not at all; by the predicted "
             "motion; or again, by the motion found, before points enter the map. Scans that the "
             "authors of a data set deskewed are left alone."),
      boolean(
          "odometry.paper.pixel_centres", LILO_MEMBER(odometry.paper.pixel_centres), kRestart,
          "Rebuild points in the middle of their image column, as the paper prints; false: keep "
          "the exact return of the pixel."),
      real("odometry.paper.sobel_edge_m", LILO_MEMBER(odometry.paper.sobel_edge_m), 0.05, 50.0, "m",
           kRestart, "Horizontal Sobel response (gain 8) above which a pixel is an edge."),
      real("odometry.paper.sobel_ground_m", LILO_MEMBER(odometry.paper.sobel_ground_m), 0.05, 50.0,
           "m", kRestart, "Vertical Sobel response (gain 8) above which a pixel is ground."),
      boolean("odometry.paper.drop_shadow_edges", LILO_MEMBER(odometry.paper.drop_shadow_edges),
              kRestart,
              "Keep the nearer side of a jump in depth only; the farther one is a shadow."),
      real("odometry.paper.fourier_ratio", LILO_MEMBER(odometry.paper.fourier_ratio), 0.001, 1.0,
           "", kRestart, "With fourier: ground is where less than this part of the range varies."),
      real("odometry.paper.edge_voxel_m", LILO_MEMBER(odometry.paper.edge_voxel_m), 0.05, 5.0, "m",
           kRestart, "Voxel grid of edges, in the scan and in the map. Larger is faster."),
      real("odometry.paper.surface_voxel_m", LILO_MEMBER(odometry.paper.surface_voxel_m), 0.05, 5.0,
           "m", kRestart, "The same for surfaces and ground."),
      real("odometry.paper.neighbourhood_m", LILO_MEMBER(odometry.paper.neighbourhood_m), 0.1, 10.0,
           "m", kRestart, "Radius of the map points that a line or a plane is fitted to."),
      real("odometry.paper.map_radius_m", LILO_MEMBER(odometry.paper.map_radius_m), 10.0, 1000.0,
           "m", kRestart, "The map is cropped to a box of this half-width around the sensor."),
      real("odometry.paper.huber_m", LILO_MEMBER(odometry.paper.huber_m), 0.001, 10.0, "m",
           kRestart, "Residuals beyond this weigh less."),
      integer("odometry.paper.max_iterations", LILO_MEMBER(odometry.paper.max_iterations), 1, 100,
              "", kRestart, "Gauss-Newton steps a scan, at most."),
      real("odometry.paper.keyframe_m", LILO_MEMBER(odometry.paper.keyframe_m), 0.0, 10.0, "m",
           kRestart,
           "The map grows when the sensor has moved so far since it last grew; 0: every scan."),
      angle("odometry.paper.keyframe_deg", LILO_MEMBER(odometry.paper.keyframe_rad), 0.0, 45.0,
            kRestart, "The same for turning."),
      real("odometry.paper.search_again", LILO_MEMBER(odometry.paper.search_again), 0.0, 1.0, "",
           kRestart,
           "Map points around a feature are sought anew once it has moved by this part of "
           "neighbourhood_m. Larger is faster; 0: at every step."),
  };
}

}  // namespace lilo
