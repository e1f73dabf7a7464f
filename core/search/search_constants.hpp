// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

/// What the searches on the grid choose (hypothesis.hpp).
namespace lilo::core::search {

/// Scans of which a motion is judged.
inline constexpr std::size_t kScans = 6;
/// What a vehicle may change of its motion, in a bend and unseen.
inline constexpr double kAcceleration_mps2 = 4.0;
inline constexpr double kTurn_radps = 1.0;

// Of the initial motion, between scans 0.1 s apart.
inline constexpr double kStep_mps = 1.0;  ///< grid step of the speed
/// Yaw rate that moves what is 5 m away as far as 1 m/s does: the step of one for a step of the
/// other.
inline constexpr double kYawPerSpeed_radpm = 0.2;
inline constexpr int kSpeeds = 40;  ///< up to 40 m/s
inline constexpr int kHeadings = 16;
inline constexpr int kYawRates = 10;                  ///< to either side: up to 2 rad/s
inline constexpr std::size_t kMostHypotheses = 4096;  ///< memory for all of these
inline constexpr int kRefinements = 3;                ///< each halves the step
/// 1 sigma of a velocity that was searched.
inline constexpr double kSearched_mps = 1.0;
/// Motions nearer to each other than this count as one.
inline constexpr double kSameMotion_mps = 3.0;

// Of a false motion, over the half second that six scans take.
inline constexpr std::array<double, 4> kFalseMotions_mps{1.0, 2.0, 3.0, 4.0};

// Of a lost place, on the map. At 20 m a step of yaw moves things as far as a step along.
inline constexpr double kStep_m = 1.0, kStep_rad = 0.05;
inline constexpr int kCoarse = 2;            ///< coarse search: steps at a time
inline constexpr int kMapAround = 1;         ///< cells by which the map is drawn thicker
inline constexpr std::size_t kRefined = 12;  ///< best coarse hypotheses that are refined
/// Places nearer to each other than this count as one.
inline constexpr double kSamePlace_m = 1.5;

// Significance, in sigmas.
inline constexpr double kClearly = 2.0;  ///< to prefer a hypothesis
inline constexpr double kBeyondDoubt =
    3.0;                                  ///< to drop one on few points, a usual motion, a session
inline constexpr double kProbably = 1.0;  ///< to restart from another motion

}  // namespace lilo::core::search
