#pragma once

#include "core/odometry_config.hpp"
#include "core/scan.hpp"
#include "core/standard/feature_image.hpp"

#include <cstddef>
#include <vector>

namespace lilo {

/// What the odometry looks at instead of all returns of a scan. Its memory is reused.
struct ScanFeatures {
  std::vector<standard::Feature> all;  ///< profile paper: none, it takes the scan
};

/// Finds the features of a scan while the scan is still being measured, so that only registration
/// is left to do after its last firing. The features are the same bits whether and how often
/// follow() was called.
/// Not thread-safe; the one thread need not be the one that calls Odometry.
class FeatureExtractor {
 public:
  explicit FeatureExtractor(const OdometryConfig& config);

  /// Takes what is new in a scan that is being written. The newest returns wait for a later call,
  /// because a packet that was overtaken may still get in among them.
  void follow(const Scan& scan);
  /// Returns were inserted at `index` into the scan being followed.
  void inserted(std::size_t index);
  /// The scan is whole: takes the rest, and `out` becomes its features. The next call is about
  /// another scan.
  void finish(const Scan& scan, ScanFeatures& out);

 private:
  void take(const Scan& scan, std::size_t end);

  bool idle_;  // the profile has no use for features
  standard::FeatureImage image_;
  std::size_t taken_ = 0;  // returns of the scan being followed
  bool spoilt_ = false;    // returns came in before some that were taken
};

}  // namespace lilo
