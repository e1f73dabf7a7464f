#pragma once

#include <cstdint>

namespace lilo {

/// Every choice of the odometry. Defaults are those of profile `default`.
struct OdometryConfig {
  double max_range_m = 100.0;
  double min_range_m = 1.0;
};

}  // namespace lilo
