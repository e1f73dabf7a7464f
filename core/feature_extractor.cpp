// SPDX-License-Identifier: BSD-3-Clause
#include "core/feature_extractor.hpp"

#include "core/constants.hpp"
#include "core/image/feature_image.hpp"
#include "core/image/levelling.hpp"
#include "core/image/self_filter.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lilo {
namespace {

// Five packets of a VLP-16 or an HDL-64E: networks overtake by one or two.
constexpr std::size_t kUnsettledReturns = std::size_t{5} * 384;

}  // namespace

struct FeatureExtractor::Impl {
  bool idle;  // the profile has no use for features
  core::FeatureImage image;
  core::Levelling levelling{};
  core::SelfFilter self_filter{};
  std::optional<Eigen::Quaterniond> R_level_sensor{};  // none until a scan tells it
  std::size_t taken = 0;                               // returns of the scan being followed
  bool invalidated = false;  // returns came in before some that were taken

  [[nodiscard]] Eigen::Quaterniond axes() const {
    return R_level_sensor.value_or(Eigen::Quaterniond::Identity());
  }
  /// Returns whether the axes are others now, so that features must be found again.
  bool level(const std::vector<Feature>& in_sensor_axes) {
    R_level_sensor = levelling.R_level_sensor(in_sensor_axes);
    return R_level_sensor->w() != 1.0;
  }
  void take(const Scan& scan, std::size_t end) {
    if (taken == 0) image.begin(scan.beams, axes());
    image.add(std::span(scan.returns).subspan(taken, end - taken));
    taken = end;
  }
  std::vector<Feature>& finish(const Scan& scan) {
    if (invalidated) taken = 0;
    take(scan, scan.returns.size());
    return image.finish(scan);
  }
};

FeatureExtractor::FeatureExtractor(const OdometryConfig& config)
    : impl_(std::make_unique<Impl>(
          Impl{config.profile != Profile::default_profile,
               {config.default_profile.columns, {config.min_range_m, config.max_range_m}}})) {}

FeatureExtractor::~FeatureExtractor() = default;
FeatureExtractor::FeatureExtractor(FeatureExtractor&&) noexcept = default;
FeatureExtractor& FeatureExtractor::operator=(FeatureExtractor&&) noexcept = default;

void FeatureExtractor::follow(const Scan& scan) {
  const std::size_t count = scan.returns.size();
  if (impl_->idle || impl_->invalidated || count < impl_->taken + kUnsettledReturns) return;
  impl_->take(scan, count - kUnsettledReturns);
}

void FeatureExtractor::inserted(std::size_t index) {
  if (index < impl_->taken) impl_->invalidated = true;
}

void FeatureExtractor::finish(const Scan& scan, ScanFeatures& out) {
  if (impl_->idle) return;
  std::vector<Feature>* found = &impl_->finish(scan);
  if (!impl_->R_level_sensor) {
    if (found->size() < core::tracking::kMinFeatures) {
      found->clear();
    } else if (impl_->level(*found)) {
      impl_->taken = 0;
      found = &impl_->finish(scan);
    }
  }
  if (impl_->R_level_sensor) {
    impl_->self_filter.filter(*found, impl_->image.too_near(), impl_->image.size());
  }
  std::swap(*found, out.all);
  out.R_level_sensor = impl_->axes();
  give_up();
}

void FeatureExtractor::give_up() {
  impl_->taken = 0;
  impl_->invalidated = false;
}

std::size_t most_features(const OdometryConfig& config, int rings) {
  if (config.profile != Profile::default_profile) return 0;
  const int columns = core::FeatureImage::columns_for(rings, config.default_profile.columns);
  return static_cast<std::size_t>(rings) * static_cast<std::size_t>(columns);
}

}  // namespace lilo
