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
};

Odometry::Odometry(const OdometryConfig& config)
    : impl_(config.profile == Profile::paper
                ? std::make_unique<Impl>(Impl{paper::PaperOdometry(config)})
                : std::make_unique<Impl>(Impl{standard::Tracker(config)})) {}

Odometry::~Odometry() = default;

Estimate Odometry::process(const Scan& scan, StageHook hook) {
  return std::visit([&](auto& profile) { return profile.process(scan, hook); }, impl_->profile);
}

std::vector<Eigen::Vector3f> Odometry::map_points() const {
  return std::visit([](const auto& profile) { return profile.map_points(); }, impl_->profile);
}

}  // namespace lilo
