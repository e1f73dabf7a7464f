#pragma once

#include "core/estimate.hpp"
#include "core/standard/feature_image.hpp"

#include <cstdint>
#include <vector>

/// How well some scans fall on each other under a motion that is only supposed.
namespace lilo::standard {

/// The area that what stands takes up on the ground, seen from above, when scans are laid over each
/// other as a motion says: trunks and walls coincide under the true one and smear under any other.
/// Ground counts for nothing, it looks the same at every speed. Needs neither a map nor a first
/// guess, and hardly cares how many rings hit a thing.
class Footprint {
 public:
  Footprint();

  /// Square cells taken up by the structure of all scans added since clear().
  [[nodiscard]] int cells() const { return cells_; }
  void clear();

  /// Adds the structure of one scan that lasted from `T_begin` to `T_end`, at constant velocity.
  void add(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end);

 private:
  std::vector<std::uint64_t> taken_;
  int cells_ = 0;
};

}  // namespace lilo::standard
