// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/eval/associate.hpp"
#include "tools/eval/pose_stream.hpp"

#include <array>
#include <cstdint>
#include <optional>

/// Whether an estimate may be believed where it says so. E_i are estimated poses, G_i true ones.
namespace lilo {

struct Trust {
  int sessions = 0;
  std::array<std::uint64_t, 4> status_counts{};  ///< poses, by TrackingStatus
  std::optional<double> nees;                    ///< none where no pose counts for it
  int nees_count = 0;                            ///< poses it is the mean of
  std::optional<double> nees_tracking;           ///< the same of those with status `tracking`
  std::uint64_t false_tracking = 0;              ///< poses

  /// Of the poses whose status is `tracking`; 0 where there are none.
  [[nodiscard]] double false_tracking_percent() const;
};

/// Normalised estimation error squared, e' P^-1 e: with
///     D = (E_0^-1 E_i)^-1 (G_0^-1 G_i)
/// e is translation and rotation vector of D, which is the motion from the estimated pose to the
/// true one in the sensor's frame, and P its covariance as the estimate says it. Both hold since
/// the first pose, so the stream begins where the odometry began. The mean is 6 where P is right,
/// more where it promises too much. Later sessions and poses without covariance do not count, nor
/// does the first pose, which is right by definition. Protocol and file have four digits of P: an
/// eigenvalue of its correlation below 1e-3 is taken for 1e-3.
///
/// False tracking: the status is `tracking` and the motion over the last 10 m of true path is wrong
/// by more than 1 m or 3 degrees. It is that since the last pose at least 10 m before, but never
/// since one of another session: a session's first pose stands in for it. Where that pose was not
/// tracked, its own error is no fault of this one: the motion since the last tracked pose at least
/// 10 m before must be wrong as well.
Trust trust(const PoseStream& estimate, const Matched& matched);

inline constexpr double kFalseTrackingPath_m = 10.0, kFalseTracking_m = 1.0,
                        kFalseTracking_deg = 3.0;

}  // namespace lilo
