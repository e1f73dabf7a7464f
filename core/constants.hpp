// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Every constant of profile `default` that is not in its configuration (odometry_config.hpp);
/// those of image/ are in image/constants.hpp. Its unit, its meaning and, after "Range:", the
/// values between which it hardly matters. Both ends of a range were measured: the drift of
/// simulated drives stayed within its spread or fell (core/README.md, "What mechanisms and
/// constants are worth"). Without a range a constant was not measured. Sizes of batches and of
/// memory stand where they are used.

/// Errors of the beams.
namespace lilo::core::calibration {

/// Radians: 1 sigma of every error before the first observation, and of the common one until enough
/// rings have seen the ground.
inline constexpr double kSigma_rad = 1e-3;
inline constexpr double kPriorInformation = 1.0 / (kSigma_rad * kSigma_rad);
/// Radians below the horizon, 5 degrees: where the common error is what it is said to be.
inline constexpr double kCommonAt_rad = 0.0873;
/// Radians below the horizon, 2 degrees: a ring nearer to it has the common error of a ring here.
inline constexpr double kNearHorizon_rad = 0.4 * kCommonAt_rad;
/// One of so many features is used.
inline constexpr std::size_t kStride = 8;
/// Weight of the residuals: those of neighbours have errors in common. That only one of kStride is
/// used is counted in.
inline constexpr double kWeight = 0.16;
/// Observations remembered: errors may change with temperature and years. Range: 1000 to 3000.
inline constexpr double kMemory = 1000.0;
/// Metres between two observations.
inline constexpr double kApart_m = 0.3;
/// Radians: a larger eccentricity or common error is not applied. In a scene of nothing but round
/// trunks the alignment has an error in one direction, and the estimate grows beyond this.
inline constexpr double kLargest_rad = 3.0 * kSigma_rad;
/// Radians: a smaller eccentricity is not applied. Of an exact encoder up to 0.39 mrad is found.
inline constexpr double kSmallest_rad = 0.4e-3;
/// Radians, 1 sigma of the part of the common error that does not follow from the errors of single
/// rings. With 0.2 mrad the rotation's drift with exact beams rose by 0.004 deg per 100 m in a town
/// and on a country road.
inline constexpr double kShared_rad = 0.1e-3;
/// Metres per radian: when the sensitivity of the pose exceeds this, it is subtracted from pose and
/// map, so that floats hold the differences.
inline constexpr float kRebase_m = 1e5F;
/// Radians: least 1 sigma of what an earlier run found. Some seconds of driving tell as much, so
/// that the estimates of another sensor are soon gone. Range: 0.2 to 0.6 mrad.
inline constexpr double kKeptSigma_rad = 0.4e-3;

}  // namespace lilo::core::calibration

/// Cells of the map.
namespace lilo::core::map {

/// Points that a distribution needs. Range: 3 to 12.
inline constexpr float kMinPoints = 6.0F;
/// Points that a cell remembers; older ones fade. What is seen of a thing moves with the sensor
/// that passes it. Against its oldest views every path comes out too short.
inline constexpr float kMemory = 30.0F;
/// Metres, 1 sigma of one point about the surface around it. In a young cell the points come from
/// few scans and share their errors.
inline constexpr float kPoint_m = 0.05F, kYoungPoint_m = 0.1F;
/// Keyframes up to which a cell is young. Range: 5 to 10; 2 is too few.
inline constexpr std::uint32_t kYoungCell = 5;
/// A direction gives information if the points spread (1 sigma) over less than this part of the
/// window's width; an even filling has 0.29. Range: 0.065 to 0.13; half of it costs 1.5 times the
/// drift.
inline constexpr float kThinSpread = 0.065F;
/// Least cosine between the normal of ground and the vertical. Half of it changes no drift, but
/// an abrupt turn was lost with it.
inline constexpr float kUprightCosine = 0.7F;
/// Metres: half cells farther away are forgotten. Rooms hide what is there. Range: 10 to 40.
inline constexpr double kHalfCellRadius_m = 20.0;
/// A map that is fuller than this part of its cells also forgets nearer ones: from there to a full
/// map the radius falls in proportion, to this part of itself. Range: 0.75 to 0.9; with a radius of
/// 0 a motorway drifted 1.4 times as much.
inline constexpr double kNearlyFull = 0.75, kFullRadius = 0.25;
/// Scans in which the whole map is looked through for cells to forget.
inline constexpr std::size_t kSweepScans = 64;

}  // namespace lilo::core::map

/// Motion within a scan and from scan to scan.
namespace lilo::core::motion {

/// Metres: where both share a bound, a rotation counts as the way of what is so far away.
inline constexpr double kLever_m = 10.0;

/// m/s^2, 20 g: no carrier of a sensor changes its velocity so fast over a scan. Range: 100 to 500.
/// With 50 the right solution after a wrong one was refused, and the sensor was lost.
inline constexpr double kImpossibleAcceleration_mps2 = 200.0;

/// Segments of a trajectory at most.
inline constexpr int kMaxSegments = 4;
/// Radians, 1 sigma of the motion between two knots, which gives the number of segments: 2 cm at
/// 20 m. Range: 0.5e-3 to 2e-3.
inline constexpr double kKnotMotion_rad = 1e-3;
/// Instants of a scan at which its trajectory is sampled for the points.
inline constexpr int kTrajectoryInstants = 128;

/// Seconds: span of a scan whose stamps tell none, that of 600 revolutions a minute.
inline constexpr double kNominalSpan_s = 0.1;
/// Seconds: over so long at least scans are compared with the motion model. Those at 600
/// revolutions a minute take longer.
inline constexpr double kComparedSpan_s = 0.09;
/// Nanoseconds from one scan to the next within which no firing is missing.
inline constexpr std::int64_t kNextFiring_ns = 1'000'000;
/// Seconds: shorter gaps between two firings change no information. Range: 5e-6 to 2e-5.
inline constexpr double kLeastGap_s = 1e-5;
/// Seconds: over such a gap a prediction is good to half a cell, and an alignment from there works.
inline constexpr double kShortGap_s = 0.35;
/// Seconds: after a longer gap, or if the clock was set, the sensor is predicted where it was.
inline constexpr double kLongestGap_s = 2.5;

/// Seconds: a gap not predicted counts as so long at most. The clock may have been set by years.
inline constexpr double kMostGap_s = 60.0;

/// 1 sigma (m, rad) of the pose before the first scan. Range: 0.5e-4 to 2e-4.
inline constexpr double kInitialPose = 1e-4;
/// m/s, 1 sigma of the horizontal velocity before the first scan. Range: 10 to 40.
inline constexpr double kInitialSpeed_mps = 20.0;
/// m/s, 1 sigma of the vertical velocity before the first scan. Range: 0.25 to 1.
inline constexpr double kClimb_mps = 0.5;
/// rad/s, the same of the rates: yaw; roll and pitch.
inline constexpr double kInitialYaw_radps = 0.5, kInitialTilt_radps = 0.1;

/// Weight of the newest scan in the process noise: about a second. Range: 0.1 to 0.3.
inline constexpr double kNoiseSmoothing = 0.1;
/// Factors of that estimate: what shakes faster than the scans come cancels in part between the
/// middles of two. Rotation (range: 8 to 16; with 32 one of 16 drives through rooms was lost) and
/// translation (range: 1 to 8).
inline constexpr double kFasterRotation = 16.0, kFasterTranslation = 8.0;
/// Rotation of the pose that is reported: a further factor (range: 2 to 4), and the least density
/// in parts of the nominal one (range: 0.01 to 0.1).
inline constexpr double kReportedRotation = 3.0, kReportedLeast = 0.1;
/// What one change of the velocity shows of the translation's density counts as so many times the
/// estimate at most. Less leaves more scans under vibration `degraded`; more lets motorways slip.
inline constexpr double kMostTranslation = 8.0;
/// Changes of the motion that tell how uncertain a first scan is. Range: 5 to 20, by NEES.
inline constexpr int kStartChanges = 5;
/// Seconds: shorter intervals between scans tell no process noise.
inline constexpr double kLeastInterval_s = 0.01;

/// m/s and rad/s: a scan in which the sensor was slower counts as stationary.
inline constexpr double kStationary_mps = 0.1, kStationary_radps = 0.1;
/// Scans in a row that make the sensor stationary.
inline constexpr int kStationaryScans = 5;
/// Metres from where it was stationary: it has set off.
inline constexpr double kSetOff_m = 0.1;

}  // namespace lilo::core::motion

/// One scan to the map.
namespace lilo::core::registration {

/// Far from the solution: one of so many features, kernels so many times as wide. 1 loses turns.
inline constexpr std::size_t kFarStride = 4;
/// Metres: steps below which the solution is near, and has converged; rotations count by kLever_m.
inline constexpr double kNearStep_m = 0.03, kConvergedStep_m = 3e-3;
/// Factor of a step near the solution. Weights and cells follow each step, so that the next one
/// would be about a sixth of it.
inline constexpr double kOverRelaxation = 1.2;
/// Instants of a scan; each residual counts at the nearest one.
inline constexpr int kResidualInstants = 32;

/// m/s: a sensor that is slower may be among vehicles in a jam. There structure that is at least so
/// many metres above the sensor, which is no vehicle, weighs so many times as much as lower one.
inline constexpr double kMaxJamSpeed_mps = 5.0;
inline constexpr float kTall_m = 2.3F, kTallWeight = 7.0F;

/// Part of the information from the scan below which a direction is weak.
inline constexpr double kWeakShare = 0.5;
/// The same, below which the motion along a weak direction is dead reckoned. Along a smooth tunnel
/// it is 0.03 to 0.1, because noise tilts the normals; elsewhere mostly 0.2 or more. Range: 0.15 to
/// 0.25, by NEES and by the drift in tunnels.
inline constexpr double kDeadReckonedShare = 0.15;
/// Ratio of the second smallest to the smallest eigenvalue of the translation's information, from
/// which a scan is degenerate and a motion is held. It is mostly 600 or more in tunnels, less than
/// 100 elsewhere. With 200 more poses are wrong and `tracking`; with 50 fewer are `tracking`.
inline constexpr double kDegenerateRatio = 100.0;
/// Metres of a unit vector (m, rad): a weak direction that moves less mostly turns.
inline constexpr double kMostlyTurns_m = 0.3;

/// Weight of the newest scan in the usual fit.
inline constexpr double kFitSmoothing = 0.3;
/// The same in the variance of the fit. Range: 0.05 to 0.1; with 0.3 abrupt turns were lost.
inline constexpr double kFitVarianceSmoothing = 0.1;
/// Sigmas by which a fit must be worse than usual, or the difference is chance or usual here.
inline constexpr double kPoorFitSigmas = 3.0;
/// Fit over the usual one, below which a better alignment may have been missed. A scan whose solver
/// did not converge needs as much.
inline constexpr double kDoubtfulFit = 0.5;
/// The same ratio as it comes out at a wrong place, by chance.
inline constexpr double kChanceFit = 0.25;

}  // namespace lilo::core::registration

/// Hypotheses of motion and place on the top-down grid.
namespace lilo::core::search {

/// Sigmas: to prefer a hypothesis; to drop one on a quarter of the points, or a session; to restart
/// from another motion.
inline constexpr double kPreferSigmas = 2.0, kDropSigmas = 3.0, kRestartSigmas = 1.0;

/// Cells of the grid in a metre: one is as wide as a trunk or a post with its blur.
inline constexpr int kCellsPerMetre = 2;
/// Cells: width of the grid, 256 m.
inline constexpr std::int32_t kGridCells = 512;
/// One of so many points is tried before all of them are.
inline constexpr std::size_t kSubsample = 4;
/// Attitudes of a scan whose rate of turn may not be that of the others.
inline constexpr std::size_t kTurnInstants = 16;

/// What a vehicle may change of its motion in a bend, and unseen.
inline constexpr double kMostAcceleration_mps2 = 4.0;
inline constexpr double kMostYawRate_radps = 1.0;

/// Scans of which a motion is judged.
inline constexpr std::size_t kMotionScans = 6;
/// m/s: step of the initial speed. And rad/m: yaw rate that moves what is 5 m away as far as 1 m/s.
inline constexpr double kSpeedStep_mps = 1.0, kYawPerSpeed_radpm = 0.2;
/// Steps of speed, up to 40 m/s; headings; and steps of yaw rate to either side, up to 2 rad/s.
inline constexpr int kSpeeds = 40, kHeadings = 16, kYawRates = 10;
/// Refinements, each of half the step.
inline constexpr int kRefinements = 3;
/// Part of the cells that scans could share, below which a searched velocity is doubtful. Under the
/// true motion 0.29 to 0.50 on motorways, 0.16 to 0.35 in a field; on hills 0.10 to 0.36 by chance.
inline constexpr double kLeastSearchedShare = 0.3;
/// m/s, 1 sigma of a velocity that was searched; of a doubtful one. Range: 2 to 8.
inline constexpr double kSearchedVelocity_mps = 1.0, kUnknownVelocity_mps = 4.0;
/// m/s: motions nearer to each other count as one; a map begun under another is begun again.
inline constexpr double kSameMotion_mps = 3.0;

/// m/s: how far off the motions are that are tested against the one tracked.
inline constexpr std::array<double, 4> kFalseMotions_mps{1.0, 2.0, 3.0, 4.0};
/// Scans in which all speeds of MotionSearch, forwards and backwards, have been tested as well.
inline constexpr int kSpeedParts = 8;
/// Scans in a row for which another motion must be better.
inline constexpr int kRefutingScans = 2;
/// One of so many scans is laid over the others where two motions may fit: six span 1.5 s at 10 Hz.
inline constexpr int kAmbiguityStride = 3;
/// m/s: step of the speeds tried then, by which the oldest scan moves a cell; to either side.
inline constexpr double kAmbiguityStep_mps = 1.0 / 3.0;
inline constexpr int kAmbiguitySteps = 5;
/// Weight of the newest depth of a second minimum, and the mean depth from which the motion is
/// ambiguous, in sigmas. Where everything is fixed the mean stays below 0.7 in 98 of 100 scans.
inline constexpr double kAmbiguitySmoothing = 0.5, kAmbiguousSigmas = 0.8;
/// Part of their cells that scans must share under a motion that may be the true one. As tracked it
/// is 0.01 to 0.32 on bare hills and 0.38 or more in jams where two motions fit; 0.16 to 0.49 under
/// a false motion on hills, 0.48 or more under the true one where a truck is followed.
inline constexpr double kLeastShared = 0.35;
/// Scans in a row with an ambiguous motion, after which the map is not believed.
inline constexpr int kAmbiguousScans = 10;

/// Steps of a lost place. At 20 m a step of yaw moves things as far as a step along does.
inline constexpr double kPlaceStep_m = 1.0, kYawStep_rad = 0.05;
/// Steps at a time in the coarse search.
inline constexpr int kCoarseSteps = 2;
/// Cells by which the map is drawn thicker; kCoarseSteps times as much in the coarse search.
inline constexpr int kMapAround = 1;
/// Coarse hypotheses that are refined.
inline constexpr std::size_t kRefinedPlaces = 12;
/// Places from which the scan is aligned.
inline constexpr std::size_t kMostPlaces = 3;
/// Metres: places nearer to each other count as one.
inline constexpr double kSamePlace_m = 1.5;
inline constexpr double kSamePlace_rad = kSamePlace_m / motion::kLever_m;

}  // namespace lilo::core::search

/// Scan after scan: what is believed, and when a map is given up.
namespace lilo::core::tracking {

/// Features, and matches, without which a scan says too little.
inline constexpr std::size_t kMinFeatures = 100;
/// Metres: more than half of the structure is nearer in a room.
inline constexpr float kRoom_m = 5.0F;
/// Scans in a row, each with enough features, that the map does not explain: they end a session.
inline constexpr int kScansToGiveUp = 10;
/// Good alignments in a row that confirm a map, and others in a row after which it is not
/// confirmed. With 5 of either, bare hills or vibration are `degraded` too often.
inline constexpr int kScansToConfirm = 3, kScansToDoubt = 10;

/// Weight of the newest scan in what tall structure says of the place.
inline constexpr double kTallSmoothing = 0.3;
/// It places the sensor elsewhere if it is off by more than this many standard errors and metres. A
/// standard error is that of one scan, its residuals taken as independent. Ranges: 0.6 to 1.2; 0.03
/// to 0.1, by poses that are wrong and `tracking`.
inline constexpr double kTallSigmas = 0.8, kTallOff_m = 0.05;
/// Scans in a row in which it does so before the motion is in doubt.
inline constexpr int kTallScans = 3;
/// Metres, 1 sigma of a place that confirms the motion. Range: 0.05 to 0.2.
inline constexpr double kTallKnown_m = 0.1;
/// Seconds after a doubt in which the motion must be confirmed. Range: 10 to 60.
inline constexpr double kTraffic_s = 30.0;

/// m/s, 1 sigma of a velocity near rest or near the tracked one. A motion farther off is another.
inline constexpr double kSameVelocity_mps = 0.5;
/// m/s: a change below which the initial motion is found.
inline constexpr double kConvergedVelocity_mps = 0.01;
/// Rounds in which it is refined, at most.
inline constexpr int kRefiningRounds = 15;
/// Part of the difference found that the first round goes, and the least of the others.
inline constexpr double kFirstPart = 0.5, kLeastPart = 0.25;
/// Scans after which a stationary start is checked again.
inline constexpr std::size_t kScansToRecheck = 4;

/// Part of keyframe_m that is enough in rooms and while the map is young. Range: 0.3 to 0.35; with
/// 0.4 one of 13 drives through rooms was lost.
inline constexpr double kCloseKeyframes = 0.35;
/// Keyframes of a young map, which may know too little.
inline constexpr int kYoungMap = 5;
/// Part of the features that a young map must match, or it gets another keyframe.
inline constexpr double kMatchedEnough = 0.5;

/// Radians: a turn that began within the scan.
inline constexpr double kSuddenTurn_rad = 0.8;
/// Radians: a turn that may have begun in the scan before, and the part of it before this one.
inline constexpr double kEarlierTurn_rad = 1.2, kTurnedBefore_rad = 0.4;
/// Metres, 1 sigma of a place that was searched; a turn in place ends no farther off.
inline constexpr double kFoundPlace_m = 0.5;
inline constexpr double kFoundPlace_rad = kFoundPlace_m / motion::kLever_m;
/// Least sum of the robust weights of ground: structure alone leaves height and tilt open.
inline constexpr double kMinGround = 0.5 * static_cast<double>(kMinFeatures);
/// Metres from the prediction, within which an alignment is exactly there.
inline constexpr double kInPlace_m = 0.2;

/// Metres of the way, and 1 sigma of the pose after it while it is `tracking`: half of 1 m and of 3
/// degrees, from which `lilo eval` counts it as wrong.
inline constexpr double kTrustedWay_m = 10.0, kTrusted_m = 0.5, kTrusted_rad = 0.0262;
/// Scans that count where they went less far: no status is for ever.
inline constexpr int kTrustedScans = 300;

/// Weight of the newest scan in the design effect.
inline constexpr double kDesignEffectSmoothing = 0.1;
/// Design effect over its mean, from which a scan counts by its own. Range: 1 to 2, by NEES.
inline constexpr double kUnusualDesignEffect = 2.0;
/// Least design effect: a simulation without noise is no reason to be sure.
inline constexpr double kLeastDesignEffect = 0.05;
/// Scans that share the error of a cell.
inline constexpr double kScansSharingErrors = 3.0;
/// Keyframes that a scan sees of the map at most; their errors are correlated over as many.
inline constexpr int kKeyframesInView = 13;
/// Correlated error of a keyframe's alignment, in parts of its standard error.
inline constexpr double kCorrelatedError = 0.5;
/// 1 sigma of the path's scale: paths come out too short by up to so much of their length.
inline constexpr double kPathScale = 3e-4;

}  // namespace lilo::core::tracking
