// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/simulate.hpp"

#include "tools/sim/addresses.hpp"
#include "tools/sim/block_encoder.hpp"
#include "tools/sim/hdl64_encoder.hpp"
#include "tools/sim/meta_writer.hpp"
#include "tools/sim/position_packet.hpp"
#include "tools/sim/truth_writer.hpp"
#include "tools/sim/vlp16_encoder.hpp"
#include "tools/sim/world.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

namespace lilo::sim {
namespace {

bool is_hdl64(Sensor sensor) { return sensor == Sensor::hdl64_s2 || sensor == Sensor::hdl64_s3; }

World make_world(const SimOptions& options) {
  const double length = std::max(20.0, options.motion.speed_mps * options.motion.duration_s);
  World world = build_world(options.world, options.seed, length);
  if (options.sensor_height_m) world.vehicle.sensor_height_m = *options.sensor_height_m;
  return world;
}

/// The capturing computer: stamps what comes with its own clock.
class Capture {
 public:
  Capture(PcapWriter& writer, const SimOptions& options)
      : writer_(writer), options_(options), random_(options.seed, 60) {}

  void write(const Packet& packet) {
    // The kernel sees a packet some 0.1 ms after it left; now and then later.
    const double late = random_.uniform() * random_.uniform();
    std::int64_t received = packet.sent_ns + 100'000 + static_cast<std::int64_t>(30'000.0 * late);
    received = last_ = std::max(received, last_ + 1'000);
    const FaultOptions& faults = options_.faults;
    const bool stepped = faults.host_step_at_s >= 0.0 &&
                         static_cast<double>(received) * 1e-9 >= faults.host_step_at_s;
    const double step_s = stepped ? faults.host_step_s : 0.0;
    writer_.write(addresses_of(packet), std::as_bytes(std::span(packet.payload)),
                  options_.start_utc_ns + received + static_cast<std::int64_t>(step_s * 1e9));
  }

 private:
  PcapWriter& writer_;
  const SimOptions& options_;
  Random random_;
  std::int64_t last_ = 0;
};

SensorClock make_clock(const SimOptions& options) {
  const SensorOptions& sensor = options.sensor;
  if (sensor.gps) return SensorClock(options.start_utc_ns, sensor.late_hour_wrap_s);
  return SensorClock(static_cast<std::int64_t>(sensor.clock_at_start_s * 1e9),
                     sensor.late_hour_wrap_s);
}

/// The encoder of the asked sensor; its calibration goes into the folder.
std::unique_ptr<Encoder> make_encoder(const SimOptions& options, const Rig& rig,
                                      const std::string& folder) {
  const SensorOptions& sensor = options.sensor;
  if (const BlockSensor* model = find_block_sensor(sensor.sensor)) {
    write_calibration_yaml(folder + "/calibration.yaml", block_calibration(*model), false);
    return std::make_unique<BlockEncoder>(rig, *model);
  }
  if (!is_hdl64(sensor.sensor)) {
    write_calibration_yaml(folder + "/calibration.yaml", vlp16_calibration(sensor.sensor), false);
    return std::make_unique<Vlp16Encoder>(rig);
  }
  const auto table = make_hdl64_table(sensor.sensor, sensor.two_point, options.seed);
  write_calibration_yaml(folder + "/calibration.yaml", table, sensor.two_point);
  write_calibration_xml(folder + "/db.xml", table);
  // A recording starts anywhere in the status bytes' lap.
  const std::uint64_t status_index = Random(options.seed, 71).next() % StatusBytes::kLap;
  return std::make_unique<Hdl64Encoder>(rig, table, options.start_utc_ns, status_index);
}

/// Lets the sensor run; returns when its last packet ends.
std::int64_t record(const SimOptions& options, Encoder& encoder, SensorClock& clock, Faults& faults,
                    SimSummary& summary, const std::function<void(double)>& progress) {
  const auto duration_ns = static_cast<std::int64_t>(options.motion.duration_s * 1e9);
  const bool sends_position = options.sensor.gps && !is_hdl64(options.sensor.sensor);
  std::int64_t next_position = 0, start = 0;
  bool was_silent = false;
  for (; start + encoder.period_ns() <= duration_ns; start += encoder.period_ns()) {
    const bool silent = faults.is_silent(start + encoder.period_ns());
    if (was_silent && !silent) {  // power is back
      encoder.power_up();
      if (!options.sensor.gps) clock.restart(start);
    }
    was_silent = silent;
    Packet packet = encoder.encode(start);
    const std::int64_t sent_ns = packet.sent_ns;
    faults.send(std::move(packet));
    ++summary.packets_sent;
    if (sends_position && sent_ns >= next_position) {
      faults.send(encode_position(sent_ns, options.start_utc_ns, clock.stamp_us(sent_ns)));
      ++summary.position_packets;
      next_position += kPositionPeriod_ns;
    }
    if (summary.packets_sent % 64 == 0) {
      progress(static_cast<double>(start) / static_cast<double>(duration_ns));
    }
  }
  faults.flush();
  return start;
}

void count_losses(std::vector<Revolution>& revolutions, const std::vector<std::int64_t>& lost_ns) {
  for (const std::int64_t lost : lost_ns) {
    const double time_s = static_cast<double>(lost) * 1e-9;
    const auto at = std::find_if(revolutions.begin(), revolutions.end(), [&](const Revolution& r) {
      return time_s >= r.start_s && time_s < r.end_s;
    });
    if (at != revolutions.end()) ++at->packets_lost;
  }
}

}  // namespace

SimSummary simulate(const SimOptions& options, const std::string& folder,
                    const std::function<void(double)>& progress) {
  World world = make_world(options);
  MotionOptions motion = options.motion;
  motion.seed = options.seed;
  const Drive drive(motion, world.vehicle, world.route);
  const SensorPath path(motion, world.vehicle, world.route, drive, world.scene.terrain);
  add_travellers(world, drive, motion.duration_s, options.seed);
  world.scene.finish();

  std::filesystem::create_directories(folder);
  const Rotor rotor(options.sensor, options.seed);
  SensorClock clock = make_clock(options);
  Laser laser(world.scene, path, options.sensor, options.seed);
  const std::unique_ptr<Encoder> encoder =
      make_encoder(options, Rig{options.sensor, path, rotor, clock, laser}, folder);
  PcapWriter writer(folder + "/data.pcap", options.nanosecond_pcap);
  Capture capture(writer, options);
  Faults faults(options.faults, options.seed, [&](const Packet& packet) { capture.write(packet); });
  SimSummary summary;
  const std::int64_t end_ns = record(options, *encoder, clock, faults, summary, progress);
  writer.close();

  summary.faults = faults.counts();
  auto revolutions = complete_revolutions(rotor, static_cast<double>(end_ns) * 1e-9);
  count_losses(revolutions, faults.lost_ns());
  const PathSummary drawn =
      write_truth(folder, path, revolutions, options.start_utc_ns, motion.duration_s);
  summary.revolutions = revolutions.size();
  summary.path_length_m = drawn.length_m;
  write_meta(folder, options, summary, drawn, world.scene, rotor);
  progress(1.0);
  return summary;
}

}  // namespace lilo::sim
