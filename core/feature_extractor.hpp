// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"
#include "core/odometry_config.hpp"
#include "core/scan.hpp"

#include <cstddef>
#include <memory>

namespace lilo {

/// Finds the features of a scan while the scan is still being measured, so that only registration
/// is left to do after its last firing. The features are the same bits whether and how often
/// follow() was called.
///
/// The first scan with at least tracking::kMinFeatures features tells whether the sensor is tilted
/// (core::Levelling), and is taken once more if it is. All scans from it on are in the level axes
/// found, as long as the extractor lives, also if that scan did not show the ground. (A version
/// that asked later scans too got worse in rooms.) Earlier ones are given no features: they have
/// too few to be aligned. Features of the robot itself are left out (core::SelfFilter). What it is
/// follows from the scans that were finished before.
/// Not thread-safe; the one thread need not be the one that calls Odometry.
class FeatureExtractor {
 public:
  explicit FeatureExtractor(const OdometryConfig& config);
  ~FeatureExtractor();
  FeatureExtractor(FeatureExtractor&&) noexcept;
  FeatureExtractor& operator=(FeatureExtractor&&) noexcept;

  /// Takes the new returns of a scan that is being written. The newest ones wait for a later call,
  /// because a late packet may still insert returns among them.
  void follow(const Scan& scan);
  /// Returns were inserted at `index` into the scan being followed.
  void inserted(std::size_t index);
  /// The scan is whole: takes the rest of it and writes its features to `out`. The next call begins
  /// another scan.
  void finish(const Scan& scan, ScanFeatures& out);
  /// Nobody wants the features of the scan being followed: the next call is about another one.
  void give_up();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The most features that a scan of a sensor with so many rings can have, to reserve memory.
std::size_t most_features(const OdometryConfig& config, int rings);

}  // namespace lilo
