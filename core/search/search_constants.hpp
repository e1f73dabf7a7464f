#pragma once

#include <array>
#include <cstddef>

/// Every number that the searches on the grid choose (hypothesis.hpp). Steps belong to the cell of
/// 0.5 m: a hypothesis moves what is seen by about a cell from one step to the next.
namespace lilo::core::search {

// Of the initial motion, between scans 0.1 s apart.
inline constexpr double kStep_mps = 1.0;    ///< grid step of the speed
inline constexpr double kStep_radps = 0.2;  ///< of the yaw rate
inline constexpr int kSpeeds = 40;          ///< up to 40 m/s
inline constexpr int kHeadings = 16;
inline constexpr int kYawRates = 10;                  ///< to either side: up to 2 rad/s
inline constexpr double kMostSideways_mps2 = 4.0;     ///< the faster a vehicle, the less it turns
inline constexpr std::size_t kMostHypotheses = 4096;  ///< memory for all of these
/// Refinement: steps of the speed, and the yaw rate that moves distant things as far as 1 m/s does.
inline constexpr std::array<double, 3> kRefinements_mps{0.5, 0.25, 0.125};
inline constexpr double kYawPerSpeed_radpm = 0.2;
/// Motions nearer to each other than this count as one.
inline constexpr double kSameMotion_mps = 3.0, kSameMotion_radps = 0.5;

// Of a false motion, over the half second that six scans take.
inline constexpr std::array<double, 4> kFalseMotions_mps{1.0, 2.0, 3.0, 4.0};

// Of a lost place, on the map. At 20 m a step of yaw moves things as far as a step along.
inline constexpr double kStep_m = 1.0, kStep_rad = 0.05;
inline constexpr double kCoarse = 2.0;       ///< coarse search: steps at a time
inline constexpr int kMapAround = 1;         ///< cells by which the map is drawn thicker
inline constexpr int kCoarseMapAround = 2;   ///< the same for the coarse search
inline constexpr std::size_t kRefined = 12;  ///< best coarse hypotheses that are refined
inline constexpr double kSamePlace_m = 1.5, kSamePlace_rad = 0.1;

// Significance, in sigmas.
inline constexpr double kClearly = 2.0;      ///< to prefer a hypothesis
inline constexpr double kBeyondDoubt = 3.0;  ///< to drop one on few points, or a usual motion
inline constexpr double kProbably = 1.0;     ///< to restart from another motion

}  // namespace lilo::core::search
