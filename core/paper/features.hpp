// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/paper/range_image.hpp"
#include "core/pose.hpp"

#include <opencv2/core.hpp>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

/// From labelled pixels back to points: Section 3.3.
namespace lilo::paper {

/// A point of a scan or of the map. `intensity` holds when it was measured, as a part of the
/// scan's duration in [0, 1]; the map ignores it.
using Point = pcl::PointXYZI;
using Cloud = pcl::PointCloud<Point>;

/// P_E, P_S and P_G of Eq. 19, each point in the sensor's frame of its own instant.
struct Features {
  Cloud::Ptr edges{new Cloud};
  Cloud::Ptr surfaces{new Cloud};
  Cloud::Ptr ground{new Cloud};
};

/// Eqs. 14-19: a point a labelled pixel (Eq. 17: of filled pixels only).
/// The paper rebuilds x and y from the column's centre (Eqs. 14-16) and takes z from the image Pz
/// of Eq. 18; at 0.5 degrees a column is 17 cm wide at 20 m, so here the pixel's own return is
/// taken, unless `pixel_centres` asks for the print. What Eqs. 14 and 15 write ||I - z|| is read as
/// sqrt(I^2 - z^2), the distance in the horizontal plane. Pixels that interpolation made lie on the
/// straight line between their two returns.
Features reconstruct(const Scan& scan, const RangeImage& image, const cv::Mat1b& labels,
                     bool pixel_centres = false);

/// PCL voxel grid, one centroid a voxel of `leaf_m`: of a scan's features (Section 1) and of the
/// local maps (Section 4). The paper is silent on the size.
Cloud::Ptr voxel_grid(const Cloud::Ptr& cloud, double leaf_m);

/// Section 4, after F-LOAM: moves every point from the sensor's frame at its own instant to the
/// frame at the end of the scan. `T_start_end`: the sensor's motion during the scan, at constant
/// velocity. To 1/64 of the scan.
void deskew(const Pose& T_start_end, const Cloud& raw, Cloud& deskewed);

}  // namespace lilo::paper
