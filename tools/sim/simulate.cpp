#include "tools/sim/simulate.hpp"

#include "tools/sim/meta_writer.hpp"
#include "tools/sim/pcap_writer.hpp"
#include "tools/sim/position_packet.hpp"
#include "tools/sim/truth_writer.hpp"
#include "tools/sim/vlp16_encoder.hpp"
#include "tools/sim/world.hpp"

#include <algorithm>
#include <filesystem>

namespace lilo::sim {
namespace {

World make_world(const SimOptions& options) {
  const double length = std::max(20.0, options.motion.speed_mps * options.motion.duration_s);
  World world = build_world(options.world, options.seed, length);
  if (options.sensor_height_m) world.vehicle.sensor_height_m = *options.sensor_height_m;
  return world;
}

/// The network and the capturing computer between sensor and file.
class Capture {
 public:
  Capture(PcapWriter& writer, const SimOptions& options)
      : writer_(writer), options_(options), random_(options.seed, 60) {}

  void operator()(const Packet& packet) {
    // The kernel sees a packet some 0.1 ms after it left; now and then later.
    const auto delay =
        static_cast<std::int64_t>(100'000.0 + 30'000.0 * random_.uniform() * random_.uniform());
    std::int64_t received = packet.sent_ns + delay;
    received = std::max(received, last_ + 1'000);
    last_ = received;
    writer_.write(packet, options_.start_utc_ns + received);
  }

 private:
  PcapWriter& writer_;
  const SimOptions& options_;
  Random random_;
  std::int64_t last_ = 0;
};

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

  const Rotor rotor(options.sensor, options.seed);
  const SensorClock clock(options.start_utc_ns);
  Laser laser(world.scene, options.sensor, options.seed);
  Vlp16Encoder encoder(Rig{options.sensor, path, rotor, clock, laser});

  std::filesystem::create_directories(folder);
  PcapWriter writer(folder + "/data.pcap", options.nanosecond_pcap);
  Capture capture(writer, options);
  SimSummary summary;
  const auto duration_ns = static_cast<std::int64_t>(motion.duration_s * 1e9);
  std::int64_t next_position = 0, start = 0;
  for (; start + encoder.period_ns() <= duration_ns; start += encoder.period_ns()) {
    const Packet packet = encoder.encode(start);
    capture(packet);
    ++summary.packets_sent;
    if (options.sensor.gps && packet.sent_ns >= next_position) {
      capture(
          encode_position(packet.sent_ns, options.start_utc_ns, clock.stamp_us(packet.sent_ns)));
      ++summary.position_packets;
      next_position += kPositionPeriod_ns;
    }
    if (summary.packets_sent % 64 == 0) {
      progress(static_cast<double>(start) / static_cast<double>(duration_ns));
    }
  }
  writer.close();
  const std::vector<Revolution> revolutions =
      complete_revolutions(rotor, static_cast<double>(start) * 1e-9);
  const PathSummary drawn =
      write_truth(folder, path, revolutions, options.start_utc_ns, motion.duration_s);
  summary.revolutions = revolutions.size();
  summary.path_length_m = drawn.length_m;
  write_calibration_yaml(folder + "/calibration.yaml", vlp16_calibration(options.sensor.sensor),
                         false);
  write_meta(folder, options, summary, drawn, world.scene, rotor);
  progress(1.0);
  return summary;
}

}  // namespace lilo::sim
