// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"

namespace lilo::core {

/// Whether a map is confirmed, so that `tracking` may be said. Where scans tell little, an
/// alignment with a false map or under a false motion is good now and then, for a scan or two. So a
/// map is confirmed by tracking::kScansToConfirm good alignments in a row, until there was none in
/// kScansToDoubt scans.
class Confirmation {
 public:
  /// Without waiting.
  void confirm() {
    is_confirmed_ = true;
    contradicting_scans_ = 0;
  }
  /// The next scan, and whether its alignment was good.
  void add(bool is_good) {
    contradicting_scans_ = is_good == is_confirmed_ ? 0 : contradicting_scans_ + 1;
    const int most = is_confirmed_ ? tracking::kScansToDoubt : tracking::kScansToConfirm;
    if (contradicting_scans_ < most) return;
    is_confirmed_ = is_good;
    contradicting_scans_ = 0;
  }
  [[nodiscard]] bool is_confirmed() const { return is_confirmed_; }

 private:
  bool is_confirmed_ = false;
  int contradicting_scans_ = 0;  // in a row
};

}  // namespace lilo::core
