// SPDX-License-Identifier: BSD-3-Clause
// Captures of an independent simulator, with the time of every whole revolution.
#include "drivers/scan_source.hpp"
#include "tests/drivers/data_dir.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace lilo {
namespace {

struct Revolution {
  double start_s, end_s;
};

// revs.csv: index,t_start,t_mid,t_end,points,gap
std::vector<Revolution> read_revolutions(const std::string& set) {
  std::ifstream in(test::data_path(set + "/revs.csv"));
  std::vector<Revolution> revolutions;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string index, start, middle, end;
    std::getline(fields, index, ',');
    std::getline(fields, start, ',');
    std::getline(fields, middle, ',');
    std::getline(fields, end, ',');
    revolutions.push_back({std::stod(start), std::stod(end)});
  }
  return revolutions;
}

class SimulatedSet : public testing::TestWithParam<const char*> {};

TEST_P(SimulatedSet, RevolutionsAreThoseOfTheTruth) {
  const std::string set = GetParam();
  LILO_NEED_DATA(set);
  const auto truth = read_revolutions(set);
  // One firing, and the 0.01 degree steps of the azimuth it is found by.
  const double firing_s = 55.296e-6 + 0.1 / 36000.0;
  auto source = open_scans(test::data_path(set + "/data.pcap"), {});
  Scan scan;
  std::size_t k = 0;
  for (; source->next(scan); ++k) {
    ASSERT_LT(k, truth.size());
    ASSERT_TRUE(scan.complete) << k;
    ASSERT_EQ(scan.clock, ClockSource::gps) << k;
    // Doubles hold UTC seconds to 0.24 us.
    ASSERT_NEAR(static_cast<double>(scan.start_ns) * 1e-9, truth[k].start_s, firing_s) << k;
    ASSERT_NEAR(static_cast<double>(scan.end_ns) * 1e-9, truth[k].end_s, firing_s) << k;
  }
  EXPECT_EQ(k, truth.size());
  EXPECT_EQ(source->driver_counts().packets_lost, 0U);
  EXPECT_EQ(source->driver_counts().malformed_packets, 0U);
  EXPECT_EQ(source->driver_counts().sensor_restarts, 0U);
  EXPECT_EQ(source->error(), "");
}

INSTANTIATE_TEST_SUITE_P(Vlp16, SimulatedSet, testing::Values("sim_vlp16_park", "sim_vlp16_town"));
INSTANTIATE_TEST_SUITE_P(Hdl64e, SimulatedSet, testing::Values("sim_hdl64_town"));

}  // namespace
}  // namespace lilo
