// How many times faster than the sensor sends are packets decoded and put together to scans, on one
// core, and what a plain copy of the same packets costs in the same run. "x_sensor" is the factor.
#include "tests/drivers/packets.hpp"

#include <benchmark/benchmark.h>

#include <cstring>
#include <filesystem>

namespace lilo {
namespace {

using test::TimedPacket;

class Slots final : public ScanSink {
 public:
  Scan& exchange(Scan& finished) override {
    returns_ += finished.returns.size();
    Scan& other = &finished == &scans_[0] ? scans_[1] : scans_[0];
    other.clear();
    return other;
  }
  Scan scans_[2];
  std::size_t returns_ = 0;
};

constexpr int kTurns = 12;

const std::vector<TimedPacket>& vlp16() {
  static const auto packets = test::vlp16_packets(kTurns * 754 / 10, {});
  return packets;
}
const std::vector<TimedPacket>& vlp16_dual() {
  static const auto packets = test::vlp16_packets(kTurns * 1508 / 10, {.mode = test::Mode::dual});
  return packets;
}
const std::vector<TimedPacket>& hdl64e() {
  static const auto packets =
      test::hdl64e_packets(kTurns * 3472 / 10, {.calibration = test::sample_calibration(true)});
  return packets;
}

SensorConfig config_for_all() {
  const std::string file =
      (std::filesystem::temp_directory_path() / "lilo_decode_bench.yaml").string();
  store_calibration(file, test::sample_calibration(true));
  SensorConfig config;
  config.calibration_file = file;
  return config;
}

void report(benchmark::State& state, std::size_t packets, double sensor_packets_per_s) {
  const auto total = static_cast<double>(state.iterations()) * static_cast<double>(packets);
  state.counters["x_sensor"] =
      benchmark::Counter(total / sensor_packets_per_s, benchmark::Counter::kIsRate);
  state.counters["packets"] = benchmark::Counter(total, benchmark::Counter::kIsRate);
}

void decode(benchmark::State& state, const std::vector<TimedPacket>& packets, double rate) {
  const SensorConfig config = config_for_all();
  std::vector<PacketView> views;
  views.reserve(packets.size());
  for (const TimedPacket& packet : packets) views.push_back(packet.view());
  Slots slots;
  for (auto _ : state) {
    state.PauseTiming();
    ScanBuilder builder(config, slots.scans_[0], slots);
    state.ResumeTiming();
    for (const PacketView& view : views) builder.feed(view);
    benchmark::DoNotOptimize(slots.returns_);
  }
  report(state, packets.size(), rate);
}

void copy(benchmark::State& state, const std::vector<TimedPacket>& packets, double rate) {
  std::vector<std::byte> target(packets.size() * 1206);
  for (auto _ : state) {
    std::byte* at = target.data();
    for (const TimedPacket& packet : packets) {
      std::memcpy(at, packet.bytes.data(), packet.bytes.size());
      at += packet.bytes.size();
    }
    benchmark::ClobberMemory();
  }
  report(state, packets.size(), rate);
}

// Packets a second: VLP-16 manual 9.3; HDL-64E S2 manual, 6 shots of 48 us a packet.
BENCHMARK_CAPTURE(decode, vlp16, vlp16(), 753.5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(copy, vlp16, vlp16(), 753.5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode, vlp16_dual, vlp16_dual(), 1507.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode, hdl64e, hdl64e(), 3472.2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(copy, hdl64e, hdl64e(), 3472.2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lilo

BENCHMARK_MAIN();
