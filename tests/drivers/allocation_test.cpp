// SPDX-License-Identifier: BSD-3-Clause
// After the first revolution packets become scans without touching the heap.
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

std::atomic<std::uint64_t> allocations{0};

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;  // NOLINT(cppcoreguidelines-no-malloc)
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }  // NOLINT
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}  // NOLINT

namespace lilo {
namespace {

// Two slots that take turns, as in the daemon's ring.
class Slots final : public ScanSink {
 public:
  Scan& exchange(Scan& finished) override {
    ++finished_;
    Scan& other = &finished == &scans_[0] ? scans_[1] : scans_[0];
    other.clear();
    return other;
  }
  Scan scans_[2];
  int finished_ = 0;
};

// From the packet after the one that ends the first revolution on.
std::uint64_t allocations_after_first_revolution(const std::vector<test::TimedPacket>& packets,
                                                 const SensorConfig& config) {
  Slots slots;
  ScanBuilder builder(config, slots.scans_[0], slots);
  std::uint64_t before = 0;
  for (const test::TimedPacket& packet : packets) {
    const bool first_revolution = slots.finished_ == 0;
    builder.feed(packet.view());
    if (first_revolution) before = allocations;
  }
  EXPECT_GT(slots.finished_, 2);
  return allocations - before;
}

struct Case {
  const char* name;
  std::vector<test::TimedPacket> (*packets)();
  ReturnChoice returns = ReturnChoice::both;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

// The sensor comes into the open after a turn: many times the returns of the first one.
std::vector<test::TimedPacket> blind_first(std::vector<test::TimedPacket> packets, int turn) {
  for (int i = 0; i < turn + turn / 5; ++i) {
    std::vector<std::byte>& bytes = packets[static_cast<std::size_t>(i)].bytes;
    for (std::size_t b = 0; b < 12; ++b)
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(100 * b + 4), 96, std::byte{0});
  }
  return packets;
}

std::vector<test::TimedPacket> vlp16(test::Mode mode, std::uint8_t product = 0x22) {
  const int turn = mode == test::Mode::dual ? 151 : 76;
  auto packets = blind_first(test::vlp16_packets(4 * turn, {.mode = mode}, product), turn);
  const std::ptrdiff_t late = std::ptrdiff_t{2} * turn + 9;
  std::swap(packets[static_cast<std::size_t>(late)], packets[static_cast<std::size_t>(late) + 1]);
  const test::TimedPacket twice = packets[static_cast<std::size_t>(late)];
  packets.insert(packets.begin() + late + 6, twice);
  return packets;
}

std::vector<test::TimedPacket> hdl64e(bool s3, test::Mode mode) {
  const int turn =
      static_cast<int>(50e3 / ((s3 ? 57.6 : 48.0) * (mode == test::Mode::dual ? 3 : 6)));
  return blind_first(test::hdl64e_packets(5 * turn, {.drive = {.rpm = 1200, .mode = mode},
                                                     .calibration = test::sample_calibration(true),
                                                     .s3 = s3}),
                     turn);
}

std::vector<test::TimedPacket> row(SensorModel model, test::Mode mode) {
  const test::RowOptions options{.model = model, .drive = {.rpm = 1200, .mode = mode}};
  const int turn = static_cast<int>(50e3 / test::row_packet_us(options));
  return blind_first(test::row_packets(4 * turn, options), turn);
}

class Allocation : public testing::TestWithParam<Case> {};

TEST_P(Allocation, NoneAfterTheFirstRevolution) {
  SensorConfig config;
  config.returns = GetParam().returns;
  config.calibration_file =
      testing::TempDir() + "/allocation_" + std::to_string(getpid()) + ".yaml";
  ASSERT_TRUE(store_calibration(config.calibration_file, test::sample_calibration(true)));
  EXPECT_EQ(allocations_after_first_revolution(GetParam().packets(), config), 0U);
}

using test::Mode;
INSTANTIATE_TEST_SUITE_P(
    Models, Allocation,
    testing::Values(Case{"vlp16_strongest", [] { return vlp16(Mode::strongest); }},
                    Case{"vlp16_last", [] { return vlp16(Mode::last); }},
                    Case{"vlp16_dual", [] { return vlp16(Mode::dual); }},
                    Case{"vlp16_dual_strongest", [] { return vlp16(Mode::dual); },
                         ReturnChoice::strongest},
                    Case{"hi_res_dual", [] { return vlp16(Mode::dual, 0x24); }},
                    Case{"vlp32c", [] { return row(SensorModel::vlp32c, Mode::strongest); }},
                    Case{"vlp32c_dual", [] { return row(SensorModel::vlp32c, Mode::dual); }},
                    Case{"hdl32e_dual", [] { return row(SensorModel::hdl32e, Mode::dual); }},
                    Case{"vls128", [] { return row(SensorModel::vls128, Mode::strongest); }},
                    Case{"vls128_dual", [] { return row(SensorModel::vls128, Mode::dual); }},
                    Case{"hdl64e_s2", [] { return hdl64e(false, Mode::strongest); }},
                    Case{"hdl64e_s2_dual", [] { return hdl64e(false, Mode::dual); }},
                    Case{"hdl64e_s3", [] { return hdl64e(true, Mode::strongest); }},
                    Case{"hdl64e_s3_dual", [] { return hdl64e(true, Mode::dual); }}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

}  // namespace
}  // namespace lilo
