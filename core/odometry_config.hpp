// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <numbers>

namespace lilo {

/// Which odometry runs.
enum class Profile : std::uint8_t {
  default_profile,  ///< what measures best; `default` is a word of C++
  paper,            ///< the LiLO paper's method
};

/// How ground is told from the rest of the image.
enum class GroundFilter : std::uint8_t {
  by_sensor,  ///< as the paper's Section 5 chose: Fourier up to 16 beams, Sobel above
  sobel,      ///< Eq. 7: large vertical gradient
  fourier,    ///< Eqs. 11-13: rows that hardly vary along azimuth
};

/// Which features align the scan: edges with ground, surfaces, or both.
enum class FeatureGroup : std::uint8_t { EG, ES, EGS };

/// What is done about the sensor's motion within a scan (Section 4, end).
enum class Deskew : std::uint8_t {
  none,       ///< all returns count as measured at the scan's end
  one_stage,  ///< by the predicted motion; what was aligned enters the map
  two_stage,  ///< F-LOAM, the paper: the map gets the scan deskewed by the motion that was found
};

/// The paper's choices, and ours where it is silent: thresholds, voxel sizes, Huber's kernel, how
/// often the map grows and how often correspondences are sought. core/README.md says what the
/// choices are worth.
struct PaperConfig {
  int columns = 720;  ///< image width N: 360, 720 or 1024 in the paper
  /// Image height that sensors with fewer beams are interpolated to: 16 beams to 32 rows in the
  /// paper. 0: one row a beam.
  int interpolated_rows = 32;
  GroundFilter ground_filter = GroundFilter::by_sensor;
  FeatureGroup group = FeatureGroup::EGS;
  Deskew deskew = Deskew::two_stage;
  bool pixel_centres = false;  ///< Eqs. 14-16 to the letter; false: the exact return of the pixel
  double sobel_edge_m = 2.0;  ///< horizontal Sobel response (gain 8) above which a pixel is an edge
  double sobel_ground_m = 2.0;    ///< vertical Sobel response above which a pixel is ground
  bool drop_shadow_edges = true;  ///< keep the nearer side of a depth jump only; false: the print
  double fourier_ratio = 0.15;    ///< ground: what the mask leaves is below this part of the range
  double edge_voxel_m = 0.4;      ///< PCL voxel grid of edges, in the scan and in the map
  double surface_voxel_m = 0.8;   ///< the same for surfaces and ground
  double neighbourhood_m = 1.0;   ///< radius of the covariance of map points, Section 4
  double map_radius_m = 100.0;    ///< the map is cropped to a box of this half-width
  double huber_m = 0.1;           ///< residuals beyond this weigh less
  int max_iterations = 8;         ///< Gauss-Newton steps
  /// The maps grow when the sensor has moved or turned so far since they last did: a scan from the
  /// same place would add cost and the noise of its pose, but no view.
  double keyframe_m = 1.0;
  double keyframe_rad = 2.0 * std::numbers::pi / 180.0;
  /// A feature keeps its line or plane until it has moved by this part of the neighbourhood, over
  /// which the neighbourhood hardly changes. 0: sought anew at every step.
  double search_again = 0.25;
};

/// The default profile: features of the image plane on a map of Gaussian cells.
struct DefaultConfig {
  int columns = 1024;             ///< width of the range image; of 64 rings 576 at most
  int ground_features = 900;      ///< ground features aligned, about so many
  int structure_features = 1100;  ///< structure features aligned, about so many
  int map_features = 6000;        ///< features a keyframe adds to the map, at most
  double cell_m = 0.5;            ///< width of a cell; a distribution spans three of them
  int map_cells = 80000;          ///< fine cells of each kind, which bounds the memory
  double map_radius_m = 100.0;    ///< farther cells are forgotten
  double keyframe_m = 0.8;        ///< the map grows when the sensor has moved so far; in rooms
                                  ///< and at first kCloseKeyframes of it is enough
  double keyframe_rad = 2.0 * std::numbers::pi / 180.0;  ///< or turned so far
  double noise_m = 0.015;                                ///< 1 sigma of a return across a surface
  double ground_kernel = 1.5;     ///< Cauchy scale in sigmas of the map: ground is rough
  double structure_kernel = 0.7;  ///< the same, tighter: structure moves, hides and sways
  double data_weight = 0.1;       ///< neighbouring residuals are not independent: each counts less
  bool calibrate_beams = true;    ///< elevations of the rings and the encoder, while driving
  int segments = 2;  ///< of the trajectory of one scan, at least; motion::kMaxSegments at most
  int max_iterations = 12;
  /// Process noise: power densities of the acceleration's white noise, how fast the motion may
  /// change. These are the least; ProcessNoise estimates more from the motion. The rotation of the
  /// reported pose gets motion::kReportedLeast of them at least.
  double roll_pitch_density = 0.3;   ///< rad^2/s^3: suspension, rough ground
  double yaw_density = 0.3;          ///< rad^2/s^3
  double translation_density = 3.0;  ///< m^2/s^3
};

/// Every choice of the odometry that a user may want; constants.hpp has the others. Plain values;
/// see config/*.yaml for the keys.
struct OdometryConfig {
  Profile profile = Profile::default_profile;
  double min_range_m = 1.0;    ///< nearer returns are not used
  double max_range_m = 100.0;  ///< farther returns are not used
  DefaultConfig default_profile;
  PaperConfig paper;
};

/// Whether errors of the beams are estimated at all.
inline bool estimates_beams(const OdometryConfig& config) {
  return config.profile == Profile::default_profile && config.default_profile.calibrate_beams;
}

}  // namespace lilo
