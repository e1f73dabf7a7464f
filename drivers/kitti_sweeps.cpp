// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/kitti_sweeps.hpp"

#include "drivers/kitti_times.hpp"
#include "drivers/packet_source.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace lilo {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kHalfTurn_ns = 50'000'000;
constexpr std::int64_t kLongestTurn_ns = 1'000'000'000;

// The line of a scan.
std::string place(const fs::path& file, std::uint64_t number) {
  return file.string() + ":" + std::to_string(number + 1);
}

std::int64_t time_of(const fs::path& file, const KittiTimes& times_ns, std::uint64_t number) {
  if (number >= times_ns.size() || !times_ns[number]) {
    throw DriverError(place(file, number) + ": expected the time of scan " +
                      std::to_string(number) + ", found none");
  }
  return *times_ns[number];
}

std::vector<KittiSweep> sweeps_between(const fs::path& start_file, const fs::path& end_file,
                                       const std::vector<std::uint64_t>& numbers) {
  const KittiTimes starts_ns = read_kitti_times(start_file), ends_ns = read_kitti_times(end_file);
  std::vector<KittiSweep> sweeps;
  sweeps.reserve(numbers.size());
  for (const std::uint64_t number : numbers) {
    const KittiSweep sweep{time_of(start_file, starts_ns, number),
                           time_of(end_file, ends_ns, number)};
    const std::int64_t span_ns = sweep.end_ns - sweep.start_ns;
    if (span_ns <= 0 || span_ns > kLongestTurn_ns) {
      throw DriverError(place(end_file, number) + ": expected up to 1 s after " +
                        start_file.filename().string() + ", found " +
                        std::to_string(static_cast<double>(span_ns) * 1e-9) + " s");
    }
    sweeps.push_back(sweep);
  }
  return sweeps;
}

}  // namespace

std::vector<KittiSweep> kitti_sweeps(const fs::path& folder,
                                     const std::vector<std::uint64_t>& numbers) {
  const fs::path start_file = folder / "timestamps_start.txt";
  const fs::path end_file = folder / "timestamps_end.txt";
  const bool starts = fs::is_regular_file(start_file), ends = fs::is_regular_file(end_file);
  if (starts && ends) return sweeps_between(start_file, end_file, numbers);
  if (starts != ends) {
    throw DriverError((starts ? end_file : start_file).string() + ": expected it beside " +
                      (starts ? start_file : end_file).filename().string() +
                      ", found no such file");
  }
  const fs::path middle_file = folder / "timestamps.txt";
  const KittiTimes middles_ns = read_kitti_times(middle_file);
  std::vector<KittiSweep> sweeps;
  sweeps.reserve(numbers.size());
  for (const std::uint64_t number : numbers) {
    const std::int64_t middle_ns =
        middles_ns.empty() ? static_cast<std::int64_t>(number - numbers.front()) * 2 * kHalfTurn_ns
                           : time_of(middle_file, middles_ns, number);
    sweeps.push_back({middle_ns - kHalfTurn_ns, middle_ns + kHalfTurn_ns});
  }
  return sweeps;
}

void time_kitti_returns(Returns& returns, std::int64_t span_ns) {
  constexpr double kPi = std::numbers::pi;
  const double per_rad_ns = static_cast<double>(span_ns) / (2.0 * kPi);
  const double turn_ns = static_cast<double>(span_ns);
  for (Return& r : returns) {
    const double after_ns = (kPi - static_cast<double>(r.azimuth_rad)) * per_rad_ns;
    r.t_ns = static_cast<std::int32_t>(std::clamp(after_ns, 0.0, turn_ns));
  }
  std::stable_sort(returns.begin(), returns.end(),
                   [](const Return& a, const Return& b) { return a.t_ns < b.t_ns; });
}

}  // namespace lilo
