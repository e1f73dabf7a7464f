// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/recent_drift.hpp"

#include <algorithm>

namespace lilo::core {

void RecentDrift::clear() {
  for (Matrix6d& part : parts_) part.setZero();
  newest_m_ = 0.0;
  newest_scans_ = 0;
}

void RecentDrift::move(const Matrix6d& F, double way_m) {
  for (Matrix6d& part : parts_) part = F * part * F.transpose();
  newest_m_ = std::min(newest_m_ + way_m, kPart_m * (kParts + 1));  // over a gap all parts pass
  ++newest_scans_;
  while (is_newest_full()) {
    newest_ = (newest_ + 1) % parts_.size();
    parts_[newest_].setZero();
    newest_m_ = std::max(0.0, newest_m_ - kPart_m);
    newest_scans_ = 0;
  }
}

Matrix6d RecentDrift::covariance() const {
  Matrix6d sum = Matrix6d::Zero();
  for (const Matrix6d& part : parts_) sum += part;
  return sum;
}

}  // namespace lilo::core
