// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_correction.hpp"
#include "core/map/local_maps.hpp"
#include "core/motion/scan_timing.hpp"
#include "core/motion/trajectory.hpp"
#include "core/odometry_config.hpp"
#include "core/registration/solver.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lilo::core {

/// How the map may use a scan.
enum class MapUse : std::uint8_t {
  none,      ///< it was not aligned
  end_only,  ///< aligned, but perhaps wrongly: only to correct the end of the scan before it
  keyframe,  ///< it may enter the map
};

/// A scan that was aligned with the map.
struct AlignedScan {
  ScanTiming timing;
  const std::vector<Feature>& features;
  const Solution& solution;
  Pose T_odom_sensor;  ///< of its last firing
  MapUse use = MapUse::keyframe;
  std::size_t finest_level = LocalMaps::kWhole;  ///< into which its points enter
  bool is_room = false;                          ///< Observation::is_room
};

/// The local map and how it grows: by keyframes, which enter it one scan late. A scan sees its own
/// end from one side only. The next scan sees it from the other side and corrects it before its
/// points enter the map. The first keyframes enter at once, since a young map cannot wait. Cells
/// far away are forgotten.
///
/// Not thread-safe; no allocation after construction.
class KeyframeMap {
 public:
  explicit KeyframeMap(const DefaultConfig& config);

  [[nodiscard]] LocalMaps& cells() { return cells_; }
  [[nodiscard]] const LocalMaps& cells() const { return cells_; }
  [[nodiscard]] int keyframes() const { return keyframes_; }
  /// Counts how often points have entered it, or it was emptied.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

  /// The points that entered the map with the last scan, in the frame of the map.
  [[nodiscard]] std::span<const LocalMaps::Point> inserted() const { return points_; }

  /// Empties the map.
  void clear();
  /// Empties the map and makes one scan its first keyframe, at once. Its pose is the origin.
  void begin(const std::vector<Feature>& features, const Trajectory& trajectory,
             std::size_t finest_level);
  /// Takes the next scan. Returns whether it became a keyframe.
  bool grow(const AlignedScan& scan);
  /// How the scans depend on the errors of the beams that become keyframes from now on.
  void set_sensitivity(const ScanSensitivity& sensitivity) { sensitivity_ = sensitivity; }
  /// Subtracts a rigid motion from the sensitivities of all points, and of the keyframe that waits.
  void subtract_sensitivity(const PoseSensitivity& rigid);

 private:
  /// A keyframe, until the next scan has told where it ended.
  struct Held {
    std::vector<Feature> features;
    Trajectory trajectory;
    std::int64_t end_ns = 0;
    ScanSensitivity sensitivity;
    std::size_t finest_level = LocalMaps::kWhole;
    bool is_waiting = false;
  };
  [[nodiscard]] bool is_due(const AlignedScan& scan) const;
  void hold(const std::vector<Feature>& features, bool with_overhead);
  void insert_held();

  DefaultConfig config_;
  LocalMaps cells_;
  Held held_;
  ScanSensitivity sensitivity_;           // of the last scan
  Sampled sampled_;                       // of the keyframe that is inserted
  std::vector<LocalMaps::Point> points_;  // inserted after the last scan
  Pose T_odom_keyframe_;
  int keyframes_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace lilo::core
