// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"
#include "core/image/feature_image.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// Self-returns: returns of the robot that carries the sensor.
namespace lilo::core {

/// Leaves out features of the robot itself, such as a mast, a roof or a load behind the sensor.
/// They are where they were, however the robot moves. So to an odometry they are structure that
/// agrees with rest, and where little else is seen they hold the pose in place.
///
/// Neighbours in the image that are on one surface form a region (connected components). A region
/// is steady if nearly all its pixels have had one range for image::kSteadyScans scans, or from the
/// first one on. It is the robot if it is steady while other structure is not, and if all of it is
/// nearer than image::kSelfRange_m. Walls and the ground may be steady too, but they mostly go on
/// beyond that distance. Something else that keeps its place relative to the sensor, such as a
/// vehicle that drives beside it, is left out as well: it tells nothing of the motion.
///
/// Where the other structure is steady, the sensor is stationary, and only what was the robot
/// before is left out. So it is where steady regions take more than image::kMostSelfPart of the
/// image: the sensor stands in something small, such as a lift. Where there is no other structure,
/// a post beside a stationary sensor is taken for the robot until it drives.
///
/// The robot is not found where it touches the ground in view of the sensor, nor in motion
/// compensated scans, which move its returns.
///
/// Not thread-safe; no allocation while the size of the image stays the same.
class SelfFilter {
 public:
  /// Erases self-returns from the features of one scan. `too_near`: FeatureImage::too_near() of
  /// that scan, because a robot may reach from below odometry.min_range_m to beyond it.
  void filter(std::vector<Feature>& features, const std::vector<Feature>& too_near, ImageSize size);

 private:
  /// What a pixel sees.
  struct Seen {
    float range_m = 0.0F;
    int scans = 0;  ///< with this range: one more for each, several fewer for each with another
    int last = 0;   ///< scan that it was seen in, counted from 1
  };
  struct Structure {
    int all = 0, unsteady = 0;  ///< features
  };
  void begin(ImageSize size);
  /// In scans: finding the robot takes longer than leaving it out.
  [[nodiscard]] int search_period() const;
  void note(const std::vector<Feature>& returns);
  static void note(float range_m, Seen& seen);
  void find_robot(const std::vector<Feature>& features);
  /// Adds `by` for a feature of structure.
  void count(const Feature& f, int by, Structure& structure) const;
  /// Takes the region of a pixel out of `at_`, into `region_`. Returns whether all of it is near.
  bool take_region(std::size_t pixel);
  /// Adds a neighbour of `f` to the region if both are on one surface. False if it is too far.
  bool take_neighbour(const Feature& f, int column, int ring);
  [[nodiscard]] bool is_steady(const Seen& seen) const;
  [[nodiscard]] bool is_steady(const std::vector<std::size_t>& region) const;
  [[nodiscard]] bool is_self(const Feature& f) const;
  [[nodiscard]] std::size_t pixel_at(int column, int ring) const;

  ImageSize size_;
  int scans_ = 0;
  std::vector<Seen> seen_;     // of every pixel
  std::vector<float> self_m_;  // range of the robot at every pixel; 0: none
  std::vector<Feature> near_;  // of the scan in hand: features, then returns too near
  std::size_t near_features_ = 0;
  std::vector<std::int32_t> at_;                     // pixel to index in near_; -1: none, or taken
  std::vector<std::size_t> region_, found_, robot_;  // pixels
  std::vector<std::size_t> members_;                 // of the region: indices in near_
};

}  // namespace lilo::core
