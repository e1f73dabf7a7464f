// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace lilo::paper_bench {

/// A box plot's numbers: Tukey, Exploratory Data Analysis, 1977.
struct Box {
  double low = 0.0, q1 = 0.0, median = 0.0, q3 = 0.0, high = 0.0;  ///< low, high: whiskers' ends
  double mean = 0.0;
  std::vector<double> outliers;  ///< beyond the whiskers
};

/// The value below which `part` of the sorted samples lie, linear between samples (type 7 of
/// Hyndman and Fan, what most programs print). `sorted` is not empty.
double quantile(const std::vector<double>& sorted, double part);

/// Whiskers reach to the last sample within 1.5 times the height of the box from it. `samples` is
/// not empty.
Box box_of(std::vector<double> samples);

}  // namespace lilo::paper_bench
