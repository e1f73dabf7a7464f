// SPDX-License-Identifier: BSD-3-Clause
// After the first seconds scans become poses without touching the heap.
#include "core/odometry.hpp"
#include "drivers/scan_source.hpp"
#include "tests/drivers/data_dir.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <ostream>
#include <string>
#include <vector>

namespace {
std::uint64_t allocations = 0;
}  // namespace

// Inlined, GCC takes malloc() and our operator delete, or new and free(), for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;  // NOLINT(cppcoreguidelines-no-malloc)
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace lilo {
namespace {

struct Drive {
  const char* folder;
  bool calibration_file;
};
std::ostream& operator<<(std::ostream& out, const Drive& drive) { return out << drive.folder; }

class OdometryAllocation : public testing::TestWithParam<Drive> {};

// The whole drive, so also where the map is cropped, with a gap after which the place in the map is
// looked for. Eigen's own allocations (std::malloc) are not counted here; tests/daemon/hog counts
// every malloc of the worker.
TEST_P(OdometryAllocation, NoneOnceWarm) {
  constexpr std::uint64_t kWarmScans = 20, kLastBeforeGap = 60, kFirstAfterGap = 76;
  const std::string folder = test::data_path(GetParam().folder);
  LILO_NEED_DATA(GetParam().folder);
  SensorConfig sensor;
  if (GetParam().calibration_file) {
    sensor.model = SensorModel::hdl64e;
    sensor.calibration_file = folder + "/calibration.yaml";
  }
  const auto scans = open_scans(folder + "/data.pcap", sensor);
  Odometry odometry{OdometryConfig{}};
  Scan scan;
  std::vector<std::uint64_t> guilty;
  std::uint64_t count = 0;
  std::vector<Eigen::Vector3f> seen_m;
  seen_m.reserve(600);
  while (scans->next(scan)) {
    ++count;
    if (count > kLastBeforeGap && count < kFirstAfterGap) continue;
    const std::uint64_t before = allocations;
    odometry.process(scan);
    odometry.aligned_points(600, seen_m);
    odometry.mapped_points(600, seen_m);
    if (count > kWarmScans && allocations != before) guilty.push_back(count - 1);
  }
  EXPECT_GT(count, 100U);
  EXPECT_EQ(guilty, std::vector<std::uint64_t>{}) << "scans that took memory";
}

INSTANTIATE_TEST_SUITE_P(Simulated, OdometryAllocation,
                         testing::Values(Drive{"sim_vlp16_park", false},
                                         Drive{"sim_vlp16_town", false},
                                         Drive{"sim_hdl64_town", true}),
                         [](const auto& test) { return std::string(test.param.folder); });

}  // namespace
}  // namespace lilo
