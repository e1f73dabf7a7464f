#pragma once

#include <cstdint>

namespace lilo {

/// Which odometry runs.
enum class Profile : std::uint8_t { paper };

/// How ground is told from the rest of the image.
enum class GroundFilter : std::uint8_t {
  sobel,    ///< Eq. 7: large vertical gradient
  fourier,  ///< Eqs. 11-13: rows that hardly vary along azimuth
};

/// Which features align the scan: edges with ground, surfaces, or both.
enum class FeatureGroup : std::uint8_t { EG, ES, EGS };

/// The paper's choices, and ours where it is silent.
struct PaperConfig {
  int columns = 720;          ///< image width N: 360, 720 or 1024 in the paper
  int interpolated_rows = 0;  ///< image height after interpolation between beams; 0: one per beam
  GroundFilter ground_filter = GroundFilter::sobel;
  FeatureGroup group = FeatureGroup::EGS;
  double sobel_edge_m = 2.0;  ///< horizontal Sobel response (gain 8) above which a pixel is an edge
  double sobel_ground_m = 2.0;    ///< vertical Sobel response above which a pixel is ground
  bool drop_shadow_edges = true;  ///< keep the nearer side of a depth jump only; false: the print
  double fourier_ratio = 0.15;    ///< ground: what the mask leaves is below this part of the range
  double edge_voxel_m = 0.4;      ///< PCL voxel grid of edges, in the scan and in the map
  double surface_voxel_m = 0.8;   ///< the same for surfaces and ground
  double neighbourhood_m = 1.0;   ///< radius of the covariance of map points, Section 4
  double map_radius_m = 100.0;    ///< the map is cropped to a box of this half-width
  double huber_m = 0.1;           ///< residuals beyond this weigh less
  int max_iterations = 8;         ///< Gauss-Newton steps, correspondences sought at each
};

/// Every choice of the odometry. One struct, plain values; see config/*.yaml for the user's view.
struct OdometryConfig {
  Profile profile = Profile::paper;
  double min_range_m = 1.0;    ///< nearer returns are not used
  double max_range_m = 100.0;  ///< farther returns are not used
  PaperConfig paper;
};

}  // namespace lilo
