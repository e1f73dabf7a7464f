// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

/// Constants as in core/constants.hpp, which says how to read a range: from returns to features.
namespace lilo::core::image {

/// Slope (tangent) above which a surface is structure. The ground under a tilted sensor or on a
/// hill stays below it. 40 degrees. Range: 0.42 to 1.68.
inline constexpr float kSteepSlope = 0.84F;
/// Slope below which a flat surface overhead is a ceiling, however a hand tilts the sensor. 17
/// degrees. Range: 0.15 to 0.6.
inline constexpr float kLevelSlope = 0.3F;
/// Two returns are on one surface up to this many times the distance at which the rings would meet
/// a surface of that slope. Range: 1.5 to 6.
inline constexpr float kSameSurface = 3.0F;
/// Metres. Between rings that meet the ground nearer together the ground counts as straight. When
/// it did over more, every fast drive was bent.
inline constexpr float kStraightGap_m = 10.0F;
/// Metres. Between rings that meet the ground nearer together the ground counts as the parabola
/// through three rings; beyond, its height is not known. Without a limit, drives of a sensor with
/// 64 beams that err (velosim --real) got worse.
inline constexpr float kMostRingGap_m = 20.0F;
/// Change of the slope (tangent) from one pair of these rings to the next: where it is more, as on
/// rough ground, the height is not known either. With 0.02 the error in data/sim_vlp16_park was a
/// fifth larger, with 0.015 more than with 0.01.
inline constexpr float kMostSlopeChange = 0.01F;
/// Metres, horizontal: drops, flakes and dust that are farther off mostly give no return. Range: 20
/// to 30.
inline constexpr float kDropRange_m = 30.0F;
/// A return with fewer neighbours is isolated. Neighbours are in the same ring or the next ones,
/// and in columns up to kNeighbours_rad to either side. Range: 2 to 3.
inline constexpr int kLeastNeighbours = 2;
/// Radians, 0.4 degrees, rounded up to whole columns: from one firing to the next of a VLP-16 at 20
/// Hz. At 10 Hz it is half as much.
inline constexpr float kNeighbours_rad = 0.007F;
/// Part of the horizontal range by which that of a neighbour differs at most.
inline constexpr float kSameRange = 0.1F;
/// Features of structure: so many isolated ones within kDropRange_m may be twigs and wires, however
/// little else is there.
inline constexpr int kMostIsolated = 100;
/// Part of the structure within kDropRange_m: where more is isolated, it is drops. It was 0.14 at
/// most in clear air, and mostly more than 0.22 in fog, snow and dust.
inline constexpr float kMostIsolatedPart = 0.2F;
/// Radians. Azimuths nearer to the newest return, or to the first one of the scan, may still get
/// returns: the lasers of one firing of an HDL-64E look up to 18 degrees apart. Range: 0.17 to 0.7.
inline constexpr float kFiringSpread_rad = 0.35F;
/// Metres, horizontal: flat surfaces so near tell how the sensor is tilted.
inline constexpr float kNearGround_m = 15.0F;
/// A point is in a plane if it is off it by less than this part of its range. With 0.2 m, near
/// floors seen in a strip of 1 m gave planes 9 degrees off.
inline constexpr double kInGround = 0.02;
/// Thickness of ground over its width (1 sigma each) at most. Above it the points are a strip,
/// which may be tilted in any way about its length.
inline constexpr double kMostThickness = 0.08;
/// Square metres: a smaller triangle tells no plane.
inline constexpr double kLeastTriangle_m2 = 1.0;
/// Random planes that are tried: of three points each eighth is in the ground if half of all are.
inline constexpr int kPlaneTrials = 300;
/// Fits of the best one to the points that are in it.
inline constexpr int kPlaneFits = 5;
/// Radians. A sensor is levelled if it is tilted by more than the first and less than the second.
/// Stairs have 30 degrees and more.
inline constexpr double kLeastTilt_rad = 0.05, kMostTilt_rad = 0.5;
/// A plane above with more than this many times as many flat surfaces as a floor is the ground.
/// There were 11.5 times as many or more above 49 upside-down sensors of 16 beams outdoors. There
/// were 9.6 times as many at most above upright ones in halls 8 to 30 m wide, 1.8 to 3.5 m above
/// the floor and 0.3 to 1.2 m below a ceiling wider than kWidestCeiling_m.
inline constexpr double kMostCeiling = 10.0;
/// Metres, 1 sigma across: a plane above that is less wide may be the ceiling of a room, of whose
/// floor hardly anything is seen. Of 5400 scans carried through the rooms of velosim 148 saw less
/// than a third as many flat surfaces below as in a ceiling. It was 0.2 to 1.7 m wide, and wider in
/// 10 of them. The ground was 2.0 to 7.2 m wide above those upside-down sensors but one.
inline constexpr double kWidestCeiling_m = 2.0;
/// Metres: the robot itself is nearer. Range: 3 to 8.
inline constexpr float kSelfRange_m = 5.0F;
/// Metres by which the range of a pixel may differ that has one range: five times the noise of an
/// HDL-64E.
inline constexpr float kSteadyRange_m = 0.1F;
/// Scans in which the robot keeps its ranges. A robot of which less is known is believed at once: a
/// sensor that is switched on while it drives would be held in place meanwhile. Range: 10 to 100.
inline constexpr int kSteadyScans = 30;
/// Part of these scans, and part of a region's pixels: drops come in front of a robot, and its
/// edges fall into one column or the next. Range: 0.6 to 0.9, and 0.8 to 0.9.
inline constexpr double kSteadyTime = 0.8, kSteadyPart = 0.9;
/// Part of the other structure that must be unsteady, if a steady region is to be taken for the
/// robot. Where less is, the sensor is stationary: vehicles beside it were the robot then, and when
/// they set off together more often took the odometry along (`Jam.*`). Range: 0.05 to 0.1.
inline constexpr double kLeastUnsteady = 0.1;
/// Part of the image that may be the robot: half of it, if the sensor is mounted on its front.
/// Range: 0.33 to 0.6.
inline constexpr double kMostSelfPart = 0.6;
/// Metres, and part of the range: neighbours in the image that are less far apart are on one
/// surface.
inline constexpr float kSurfaceGap_m = 0.2F, kSurfaceGapPart = 0.1F;
/// Metres: ground at neighbouring rings is one surface if it differs by less in height.
inline constexpr float kGroundStep_m = 0.25F;
/// Pixels of an image at most, and so features. Range, with 64 rings: 512 to 1024 columns.
inline constexpr int kMostPixels = 64 * 576;
/// Metres: voxels of ground and of structure in the first scan, before they adapt.
inline constexpr std::array<float, 2> kFirstVoxel_m{1.0F, 0.5F};
/// Metres: bounds of a voxel.
inline constexpr float kLeastVoxel_m = 0.05F, kMostVoxel_m = 5.0F;
/// A voxel grows by this power of how many times too many features there were. On surfaces 0.5
/// would be exact; less damps.
inline constexpr float kVoxelPower = 0.35F;
/// Passes over a scan at most, until the number of features is near its goal.
inline constexpr int kVoxelPasses = 8;

}  // namespace lilo::core::image
