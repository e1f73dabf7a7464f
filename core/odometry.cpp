#include "core/odometry.hpp"

#include "core/paper/paper_odometry.hpp"

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
  paper::PaperOdometry paper;
};

Odometry::Odometry(const OdometryConfig& config)
    : impl_(std::make_unique<Impl>(Impl{paper::PaperOdometry(config)})) {}

Odometry::~Odometry() = default;

Estimate Odometry::process(const Scan& scan, StageHook hook) {
  return impl_->paper.process(scan, hook);
}

}  // namespace lilo
