#include "core/odometry.hpp"

#include "core/paper/paper_odometry.hpp"
#include "core/standard/tracker.hpp"

#include <variant>

namespace lilo {

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::project:
      return "project";
    case Stage::filter:
      return "filter";
    case Stage::reconstruct:
      return "reconstruct";
    case Stage::deskew:
      return "deskew";
    case Stage::align:
      return "align";
    case Stage::update_map:
      return "update_map";
  }
  return "unknown";
}

struct Odometry::Impl {
  std::variant<standard::Tracker, paper::PaperOdometry> profile;
  FeatureExtractor extractor;
  ScanFeatures features;
};

Odometry::Odometry(const OdometryConfig& config)
    : impl_(config.profile == Profile::paper
                ? std::make_unique<Impl>(
                      Impl{paper::PaperOdometry(config), FeatureExtractor(config), {}})
                : std::make_unique<Impl>(
                      Impl{standard::Tracker(config), FeatureExtractor(config), {}})) {}

Odometry::~Odometry() = default;

Estimate Odometry::process(const Scan& scan, StageHook hook) {
  impl_->extractor.finish(scan, impl_->features);
  if (std::holds_alternative<standard::Tracker>(impl_->profile)) hook(Stage::project);
  Estimate estimate = align(scan, impl_->features, hook);
  update_map(impl_->features, hook);
  return estimate;
}

Estimate Odometry::align(const Scan& scan, const ScanFeatures& features, StageHook hook) {
  if (auto* tracker = std::get_if<standard::Tracker>(&impl_->profile)) {
    return tracker->align(scan, features.all, hook);
  }
  return std::get<paper::PaperOdometry>(impl_->profile).process(scan, hook);
}

void Odometry::update_map(const ScanFeatures& features, StageHook hook) {
  auto* tracker = std::get_if<standard::Tracker>(&impl_->profile);
  if (tracker != nullptr) tracker->update_map(features.all, hook);
}

std::vector<Eigen::Vector3f> Odometry::map_points() const {
  return std::visit([](const auto& profile) { return profile.map_points(); }, impl_->profile);
}

}  // namespace lilo
