// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "tools/plot/canvas.hpp"

#include <string>

namespace lilo {

/// A picture of one scan: the range image (azimuth across from straight behind over straight ahead
/// to straight behind, highest beam on top), and the returns seen from above twice, coloured by
/// beam and by intensity, x to the right and y up, with rings of equal range.
Canvas draw(const Scan& scan, const std::string& title);

}  // namespace lilo
