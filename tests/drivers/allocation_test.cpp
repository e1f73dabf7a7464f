// After the first revolution packets become scans without touching the heap.
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;  // NOLINT(cppcoreguidelines-no-malloc)
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }               // NOLINT
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }  // NOLINT

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

std::uint64_t allocations_after(int warm_up, const std::vector<test::TimedPacket>& packets,
                                const SensorConfig& config) {
  Slots slots;
  ScanBuilder builder(config, slots.scans_[0], slots);
  std::uint64_t before = 0;
  for (const test::TimedPacket& packet : packets) {
    if (slots.finished_ <= warm_up) before = allocations;
    builder.feed(packet.view());
  }
  EXPECT_GT(slots.finished_, warm_up + 1);
  return allocations - before;
}

TEST(Allocation, NoneForAVlp16AfterTheFirstRevolutions) {
  auto packets = test::vlp16_packets(400, {});
  std::swap(packets[340], packets[341]);  // a late packet, and a doubled one
  packets.insert(packets.begin() + 350, packets[350]);
  EXPECT_EQ(allocations_after(2, packets, {}), 0U);
}

TEST(Allocation, NoneForAVlp16InDualMode) {
  EXPECT_EQ(allocations_after(2, test::vlp16_packets(800, {.mode = test::Mode::dual}), {}), 0U);
}

TEST(Allocation, NoneForAnHdl64e) {
  const std::string file = testing::TempDir() + "/allocation.yaml";
  ASSERT_TRUE(store_calibration(file, test::sample_calibration(true)));
  SensorConfig config;
  config.calibration_file = file;
  const test::HdlOptions options{.drive = {.rpm = 1200},
                                 .calibration = test::sample_calibration(true)};
  EXPECT_EQ(allocations_after(2, test::hdl64e_packets(900, options), config), 0U);
}

}  // namespace
}  // namespace lilo
