// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/published.hpp"

#include <array>

namespace lilo::paper_bench {
namespace {

constexpr std::array<PublishedSequence, 11> kTable1 = {{{"00", 3714, 0.71, 0.43},
                                                        {"01", 4268, 1.29, 0.20},
                                                        {"02", 5075, 1.06, 0.39},
                                                        {"03", 563, 1.22, 0.31},
                                                        {"04", 397, 0.84, 0.28},
                                                        {"05", 2223, 0.53, 0.34},
                                                        {"06", 1239, 0.54, 0.32},
                                                        {"07", 695, 0.60, 0.61},
                                                        {"08", 3225, 1.07, 0.41},
                                                        {"09", 1717, 0.63, 0.32},
                                                        {"10", 919, 0.99, 0.33}}};

/// From the readme of KITTI's odometry devkit.
constexpr std::array kRawDrives = {
    "2011_10_03_drive_0027", "2011_10_03_drive_0042", "2011_10_03_drive_0034",
    "2011_09_26_drive_0067", "2011_09_30_drive_0016", "2011_09_30_drive_0018",
    "2011_09_30_drive_0020", "2011_09_30_drive_0027", "2011_09_30_drive_0028",
    "2011_09_30_drive_0033", "2011_09_30_drive_0034"};

}  // namespace

std::optional<PublishedSequence> published_sequence(const std::string& set) {
  for (std::size_t k = 0; k < kTable1.size(); ++k) {
    const std::string number = kTable1.at(k).number;
    if (set == number || set == "kitti_" + number || set.starts_with(kRawDrives.at(k))) {
      return kTable1.at(k);
    }
  }
  return std::nullopt;
}

}  // namespace lilo::paper_bench
