// SPDX-License-Identifier: BSD-3-Clause
// For builds without profile paper.
#include "tools/plot/features_view.hpp"

#include <stdexcept>

namespace lilo {

Canvas draw_features(const Scan&, const OdometryConfig&, const std::string&) {
  throw std::runtime_error("--features: this build has no profile paper");
}

}  // namespace lilo
