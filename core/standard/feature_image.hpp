#pragma once

#include "core/scan.hpp"

#include <cstdint>
#include <vector>

/// Features found in the image plane: the paper's idea, with exact returns and in metres.
namespace lilo::standard {

enum class Kind : std::uint8_t {
  ground,     ///< flat towards the next ring, below the horizon
  structure,  ///< everything that stands: walls, poles, trunks, foliage
};

/// A return that a pixel of the image kept, and how far its surface reaches unseen.
struct Feature {
  float x_m, y_m, z_m;     ///< sensor frame at the instant of the firing
  float s;                 ///< that instant as a part of the scan's duration, in [0, 1]
  float dx_m, dy_m, dz_m;  ///< to the return of the neighbouring ring on the same surface, or zero
  Kind kind;
  std::uint8_t ring;
};

/// The spherical range image of a scan. Reused from scan to scan: no allocation after the first.
/// Columns are contiguous, because a firing fills a column and neighbouring rings are compared.
class FeatureImage {
 public:
  explicit FeatureImage(int columns) : columns_(columns) {}

  /// Projects the scan (paper Eqs. 2-5) and classifies every filled pixel by the slope to its
  /// neighbours above and below: the vertical gradient of Eq. 7, in metres instead of grey levels.
  /// The first return in a pixel stays: the nearest would pull every range nearer by its noise.
  /// The result is ordered column by column and lives until the next call.
  const std::vector<Feature>& build(const Scan& scan, double min_range_m, double max_range_m);

 private:
  struct Pixel {
    float x_m, y_m, z_m;
    float flat_m;  // distance from the sensor's axis; 0: empty
    float s;
  };
  struct Step {
    bool connected = false;  // one surface
    bool steep = false;
  };
  void project(const Scan& scan, double min_range_m, double max_range_m);
  void classify_column(const BeamTable& beams, const Pixel* column);
  void add_feature(const Pixel* column, int ring, Step below, Step above);
  static Step step_between(const Pixel& lower, const Pixel& upper, float gap_rad);

  int columns_;
  int rows_ = 0;
  std::vector<Pixel> pixels_;
  std::vector<Feature> features_;
};

}  // namespace lilo::standard
