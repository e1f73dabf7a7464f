// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"
#include "core/scan.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

/// Features found in the image plane: the paper's idea, with exact returns and in metres.
namespace lilo::core {

/// Returns nearer or farther are not used.
struct RangeLimits {
  double min_m = 1.0, max_m = 100.0;
};

struct ImageSize {
  int columns = 0, rings = 0;
  bool operator==(const ImageSize&) const = default;
};

/// The spherical range image of a scan. Reused from scan to scan: no allocation after the first.
/// Columns are contiguous, because a firing fills a column and neighbouring rings are compared.
///
/// Returns are projected (paper Eqs. 2-5), and every filled pixel is classified by the slope to its
/// neighbours above and below: the vertical gradient of Eq. 7, in metres instead of grey levels.
/// A pixel keeps its first return. To keep the nearest one would shorten every range by its noise.
///
/// Drops of fog or rain, flakes and dust give returns of single rays. Where much of the structure
/// within image::kDropRange_m is isolated in the image, the features of all isolated returns there
/// are left out, those of ground too. This is dynamic radius outlier removal (Charron et al.,
/// De-noising of Lidar Point Clouds Corrupted by Snowfall, CRV 2018) in the image plane. Isolated
/// returns still have edges with others.
///
/// A scan can be taken in parts while it is being measured: begin(), add() as often as needed,
/// finish(). Columns that the sensor has passed are classified at once. If a return still comes for
/// one of them, all columns are classified again at the end. So the features are the same bits
/// however the scan was divided.
class FeatureImage {
 public:
  FeatureImage(int columns, RangeLimits limits);
  /// The width of the image for so many rings: `most`, or less where it would get more than
  /// image::kMostPixels.
  static int columns_for(int rings, int most);

  /// `R_level_sensor`: to the axes in which returns are classified and features are told
  /// (Levelling). Rows are rings in those axes (in_level_axes()), columns the sensor's azimuths.
  void begin(const BeamTable& beams,
             const Eigen::Quaterniond& R_level_sensor = Eigen::Quaterniond::Identity());
  /// The next returns of the scan, in its order.
  void add(std::span<const Return> returns);
  /// The features, ordered column by column from straight behind, clockwise. `scan` gives the
  /// times; all of its returns must have been added. Lives until the next begin().
  std::vector<Feature>& finish(const Scan& scan);

  /// Of this scan: the first return of each pixel below RangeLimits::min_m, with its place and no
  /// more. They are no features, and a farther return may have filled their pixel later.
  [[nodiscard]] const std::vector<Feature>& too_near() const { return too_near_; }
  [[nodiscard]] ImageSize size() const { return {columns_, beams_.ring_count}; }

  /// A whole scan at once, in the sensor's axes.
  std::vector<Feature>& build(const Scan& scan);

 private:
  struct Pixel {
    float x_m, y_m, z_m;
    std::int32_t t_ns;
  };
  using Filled = std::array<std::uint64_t, kMaxRings / 64>;  // a bit for each ring
  /// One column, an array for each value. A firing may straddle two columns: where this one has no
  /// return of a ring, the return of the column before or after is used, if it is below the
  /// horizon. That is mostly ground, which continues from column to column; leaves and rails do
  /// not.
  struct ColumnView {
    std::array<float, kMaxRings> x_m, y_m, z_m;
    std::array<float, kMaxRings> horizontal_m;  ///< from the vertical through the sensor; 0: empty
    std::array<std::int32_t, kMaxRings> t_ns;
    Filled own;
    int column;
  };
  /// The edge from each ring's pixel to that of the next ring. It is flat or steep if both are on
  /// one surface, else neither. Index 2 is the edge from ring 0 to ring 1; unused edges surround
  /// it.
  struct RingEdges {
    std::array<float, kMaxRings + 3> length2_m2;
    std::array<std::int32_t, kMaxRings + 3> flat, steep;  ///< 1 or 0
    std::array<std::int32_t, kMaxRings + 3> level;        ///< flat, and a ceiling
  };
  /// How far the sensor has turned. The place of a column counts from `first_column`, in the order
  /// in which the sensor passes the columns.
  struct Sweep {
    int first_column = -1;     ///< -1: no return yet
    int front = 0;             ///< the farthest place before the seam that a return fell into
    int classified = 0;        ///< places before this one are done
    bool invalidated = false;  ///< a column that was classified got another return
  };
  /// Features of structure within image::kDropRange_m. Of those with a steep edge none is counted
  /// as isolated: they are part of something.
  struct NearStructure {
    int all = 0, isolated = 0;
  };
  struct Projector;  // in feature_image_project.cpp
  static float columns_per_rad(int columns);
  void project(std::span<const Return> returns);
  void project_crowded(const Projector& projector, std::span<const Return> returns);
  void note(int column);
  [[nodiscard]] int place_of(int column) const;
  void classify_until(int place);
  void classify_column(int column, std::vector<Feature>& out);
  void view_column(int column, ColumnView& g) const;
  /// `taken`: the rings that have a pixel.
  void set_horizontal(const Filled& taken, ColumnView& g) const;
  void find_edges(const ColumnView& g);
  void count_near(const Feature& f, bool steep);
  /// Whether too few returns in the columns and rings around it have about its horizontal range.
  /// Columns on the other side of the seam are not among them: a revolution lies between.
  [[nodiscard]] bool is_isolated(const Feature& f) const;
  void leave_out_drops();
  void add_feature(const ColumnView& g, std::size_t ring, std::vector<Feature>& out);
  /// How high the next ring above or below is over the tangent to the ground at this one. 0 if they
  /// are near (kStraightGap_m); none if the height of the ground between them is not known.
  /// `gap2_m2`: their squared distance.
  [[nodiscard]] std::optional<float> height_over_tangent_m(const ColumnView& g, std::size_t ring,
                                                           bool up, float gap2_m2) const;
  void set_sample_gap(const ColumnView& g, float to_lower2, float to_upper2, Feature& f) const;

  int most_columns_;
  int columns_ = 0;  // for these beams
  int margin_ = 0;   // in columns
  int beside_ = 1;   // columns to either side in which a return's neighbours are
  float nearest2_, farthest2_;
  BeamTable beams_;
  Eigen::Matrix3f R_level_sensor_;
  std::vector<Pixel> pixels_;   // valid where filled
  std::vector<Filled> filled_;  // of every column; apart, because most returns only read this
  std::array<float, kMaxRings> gap_rad_{};  // to the next ring; of the highest, to the one below
  RingEdges edges_;                         // of the column in hand
  std::vector<Feature> features_;
  std::vector<Feature> last_features_;  // of columns to the right of straight behind
  std::vector<Feature> too_near_;       // one a pixel
  std::vector<Filled> noted_;           // of every column: rings that are in too_near_
  Sweep sweep_;
  NearStructure near_structure_;
};

}  // namespace lilo::core
