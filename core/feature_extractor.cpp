#include "core/feature_extractor.hpp"

#include <span>
#include <utility>

namespace lilo {
namespace {

// Five packets of a VLP-16 or an HDL-64E: networks overtake by one or two.
constexpr std::size_t kUnsettledReturns = std::size_t{5} * 384;

}  // namespace

FeatureExtractor::FeatureExtractor(const OdometryConfig& config)
    : idle_(config.profile != Profile::standard),
      image_(config.standard.columns, {config.min_range_m, config.max_range_m}) {}

void FeatureExtractor::follow(const Scan& scan) {
  const std::size_t count = scan.returns.size();
  if (idle_ || spoilt_ || count < taken_ + kUnsettledReturns) return;
  take(scan, count - kUnsettledReturns);
}

void FeatureExtractor::inserted(std::size_t index) {
  if (index < taken_) spoilt_ = true;
}

void FeatureExtractor::finish(const Scan& scan, ScanFeatures& out) {
  if (idle_) return;
  if (spoilt_) taken_ = 0;
  take(scan, scan.returns.size());
  std::swap(image_.finish(scan), out.all);
  taken_ = 0;
  spoilt_ = false;
}

void FeatureExtractor::take(const Scan& scan, std::size_t end) {
  if (taken_ == 0) image_.begin(scan.beams);
  image_.add(std::span(scan.returns).subspan(taken_, end - taken_));
  taken_ = end;
}

}  // namespace lilo
