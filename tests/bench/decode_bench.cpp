// SPDX-License-Identifier: BSD-3-Clause
// How many times faster than the sensor sends are packets decoded and put together to scans, on one
// core, and what a plain copy of the same packets costs in the same run. "x_sensor" is the factor.
#include "drivers/sensor_table.hpp"
#include "tests/drivers/packets.hpp"

#include <benchmark/benchmark.h>

#include <cctype>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

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

constexpr double kSensorTimeS = 1.2;  // twelve turns

struct Case {
  std::string name;
  const SensorTable* table;
  test::DriveOptions drive;
  std::vector<TimedPacket> packets;  // made when first asked for

  const std::vector<TimedPacket>& made() {
    if (packets.empty()) make();
    return packets;
  }
  void make();
};

void Case::make() {
  const double period_ns = table->packet_period_ns(drive.mode == test::Mode::dual);
  const int count = static_cast<int>(kSensorTimeS * 1e9 / period_ns);
  if (table->model == SensorModel::vlp16) {
    packets = test::vlp16_packets(count, drive, table->product);
  } else if (table->model == SensorModel::hdl64e) {
    packets = test::hdl64e_packets(count,
                                   {.drive = drive, .calibration = test::sample_calibration(true)});
  } else {
    packets = test::row_packets(count, {.model = table->model, .drive = drive});
  }
}

std::string lower(std::string name) {
  for (char& c : name) c = c == ' ' ? '_' : static_cast<char>(std::tolower(c));
  return name;
}

// Every model known, in single and in dual return mode.
std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const SensorTable* table : sensor_tables()) {
    const std::string name = lower(table->name);
    cases.push_back({.name = name, .table = table, .drive = {}, .packets = {}});
    cases.push_back({.name = name + "_dual",
                     .table = table,
                     .drive = {.mode = test::Mode::dual},
                     .packets = {}});
  }
  return cases;
}

SensorConfig config_for_all() {
  const std::string file =
      (std::filesystem::temp_directory_path() / "lilo_decode_bench.yaml").string();
  store_calibration(file, test::sample_calibration(true));
  SensorConfig config;
  config.calibration_file = file;
  return config;
}

void report(benchmark::State& state, const std::vector<TimedPacket>& packets) {
  const auto sent_ns = static_cast<double>(packets.back().received_ns - packets[0].received_ns);
  const double sensor_packets_per_s = static_cast<double>(packets.size() - 1) * 1e9 / sent_ns;
  const auto total = static_cast<double>(state.iterations()) * static_cast<double>(packets.size());
  state.counters["x_sensor"] =
      benchmark::Counter(total / sensor_packets_per_s, benchmark::Counter::kIsRate);
  state.counters["packets"] = benchmark::Counter(total, benchmark::Counter::kIsRate);
}

void decode(benchmark::State& state, const std::vector<TimedPacket>& packets) {
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
  report(state, packets);
}

void copy(benchmark::State& state, const std::vector<TimedPacket>& packets) {
  std::vector<std::byte> target(packets.size() * 1206);
  for (auto _ : state) {
    std::byte* at = target.data();
    for (const TimedPacket& packet : packets) {
      std::memcpy(at, packet.bytes.data(), packet.bytes.size());
      at += packet.bytes.size();
    }
    benchmark::ClobberMemory();
  }
  report(state, packets);
}

void register_case(Case& c) {
  benchmark::RegisterBenchmark(("decode/" + c.name).c_str(), [&c](benchmark::State& state) {
    decode(state, c.made());
  })->Unit(benchmark::kMillisecond);
  if (c.drive.mode == test::Mode::dual) return;  // a packet has the same size
  benchmark::RegisterBenchmark(("copy/" + c.name).c_str(), [&c](benchmark::State& state) {
    copy(state, c.made());
  })->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace lilo

int main(int argc, char** argv) {
  auto cases = lilo::all_cases();
  for (auto& c : cases) lilo::register_case(c);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
