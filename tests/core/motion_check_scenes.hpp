// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/search/motion_check.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace lilo::test {

inline constexpr double kSpan_s = 0.1;
inline constexpr double kSpeed_mps = 2.0;

inline core::ScanTiming timing(double end_ns) {
  const auto end = static_cast<std::int64_t>(std::llround(end_ns));
  return {end - std::llround(1e9 * kSpan_s), end};
}

/// Takes the scan number `k`, tracked along x. Returns whether the motion is refuted.
inline bool take(core::MotionCheck& check, int k, const std::vector<Feature>& features,
                 double tracked_mps = kSpeed_mps, bool is_dead_reckoned = false) {
  Pose begin, end;
  begin.translation_m.x() = tracked_mps * kSpan_s * (k - 1);
  end.translation_m.x() = tracked_mps * kSpan_s * k;
  check.add(features, begin, end, timing(1e9 * kSpan_s * k));
  const bool is_refuted = check.compare({1.0, 0.0});
  check.observe_ambiguity({1.0, 0.0}, is_dead_reckoned);
  return is_refuted;
}

/// Bare hills: each scan sees other steep ground, in lines across the way as rings meet it. So many
/// of twelve lines lie at the same range in every scan.
class Hills {
 public:
  explicit Hills(int at_same_range) : at_same_range_(at_same_range) {}

  std::vector<Feature> scan() {
    std::vector<Feature> features;
    for (int line = 0; line < 12; ++line) {
      Feature f{};
      f.kind = FeatureKind::structure;
      const bool is_same = line < at_same_range_;
      f.x_m = is_same ? 5.0F + 4.0F * static_cast<float>(line) : anywhere_m_(random_);
      f.y_m = is_same ? -5.0F : anywhere_m_(random_);
      for (int point = 0; point < 20; ++point, f.y_m += 0.5F) features.push_back(f);
    }
    return features;
  }

 private:
  int at_same_range_;
  std::minstd_rand random_{5};
  std::uniform_real_distribution<float> anywhere_m_{-40.0F, 40.0F};
};

}  // namespace lilo::test
