// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/sim_options.hpp"

#include "tools/cli.hpp"
#include "tools/sim/meta_writer.hpp"
#include "tools/sim/world.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <tuple>
#include <vector>

namespace lilo::sim {
namespace {

/// One group of options on the help page.
class Group {
 public:
  Group(CLI::App& command, std::string name) : command_(command), name_(std::move(name)) {}

  template <typename Value>
  CLI::Option* number(const char* option, Value& value, Value low, Value high, const char* about) {
    return command_.add_option(option, value, about)
        ->check(within(static_cast<double>(low), static_cast<double>(high)))
        ->type_name(fmt::format("{}..{}", low, high))
        ->group(name_);
  }
  template <typename Value>
  void choice(const char* option, Value& value, const std::map<std::string, Value>& values,
              const char* about) {
    lilo::choice(command_.add_option(option, value, about), values)->group(name_);
  }
  void flag(const char* option, bool& value, const char* about) {
    command_.add_flag(option, value, about)->group(name_);
  }
  CLI::Option* text(const char* option, std::string& value, const char* about) {
    return command_.add_option(option, value, about)->type_name("TEXT")->group(name_);
  }

 private:
  CLI::App& command_;
  std::string name_;
};

void add_motion(CLI::App& command, SimOptions& options) {
  MotionOptions& motion = options.motion;
  Group group(command, "World and motion");
  std::vector<std::string> worlds;
  for (const WorldInfo& world : known_worlds()) worlds.push_back(world.name);
  group.text("--world", options.world, "Where to drive (list below)")
      ->check(one_of(worlds))
      ->type_name(choices(worlds))
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Another number: another world, other noise")
      ->check(count())
      ->type_name("N")
      ->capture_default_str()
      ->group("World and motion");
  group.number("--duration-s", motion.duration_s, 0.2, 7200.0, "Length of the recording")
      ->capture_default_str();
  group.number("--speed-mps", motion.speed_mps, 0.0, 60.0,
               "Speed wished for; curves are taken slower. Default: the world's");
  group.flag("--start-in-motion", motion.start_in_motion, "At speed from the first packet on");
  group.number("--standstill-s", motion.standstill_s, 0.0, 7200.0, "Standing before setting off")
      ->capture_default_str();
  group.number("--turn-rate-dps", motion.turn_rate_dps, -400.0, 400.0,
               "Turns as well; with --speed-mps 0 on the spot");
  group.number("--turn-ramp-s", motion.turn_ramp_s, 0.05, 60.0, "Until it turns so fast")
      ->capture_default_str();
  group.number("--tilt-deg", motion.tilt_deg, -45.0, 45.0, "Sensor mounted nose down");
  group.number("--roll-deg", motion.roll_deg, -180.0, 180.0,
               "Sensor mounted right side down; 180: upside down");
  group.number("--shake-dps", motion.shake_dps, 0.0, 90.0,
               "Rate, rms, at which wheels or mast shake it while it drives");
  group.number("--shake-hz", motion.shake_hz, 0.5, 20.0, "How often")->capture_default_str();
  command.add_option("--sensor-height-m", options.sensor_height_m, "Default: the world's")
      ->check(within(0.2, 5.0))
      ->type_name("0.2..5")
      ->group("World and motion");
}

void add_sensor(CLI::App& command, SensorOptions& sensor) {
  Group group(command, "Sensor");
  group.choice<Sensor>("--sensor", sensor.sensor,
                       {{"vlp16", Sensor::vlp16},
                        {"vlp16-hires", Sensor::vlp16_hires},
                        {"hdl64-s2", Sensor::hdl64_s2},
                        {"hdl64-s3", Sensor::hdl64_s3},
                        {"vlp32c", Sensor::vlp32c},
                        {"hdl32e", Sensor::hdl32e},
                        {"vls128", Sensor::vls128}},
                       "Default: vlp16");
  group.choice<ReturnMode>("--returns", sensor.returns,
                           {{"strongest", ReturnMode::strongest},
                            {"last", ReturnMode::last},
                            {"dual", ReturnMode::dual}},
                           "Default: strongest");
  group.number("--rpm", sensor.rpm, 300.0, 1200.0, "Turns per minute")->capture_default_str();
  group.number("--range-sigma-m", sensor.range_sigma_m, 0.0, 1.0,
               "Range noise. Default: 0.012, HDL-64E 0.018");
  group
      .number("--dropout", sensor.dropout, 0.0, 1.0,
              "Part of good echoes that is lost; faint ones are lost more. 0: every echo is seen")
      ->capture_default_str();
  group.number("--max-range-m", sensor.max_range_m, 1.0, 250.0,
               "No echo from beyond. Default: 100, HDL-64E, VLP-32C and VLS-128 120");
  group.flag("--two-point", sensor.two_point, "HDL-64E: near ranges need the two-point correction");
  group.flag("--turning-block", sensor.turning_block,
             "HDL-64E: the head turns while a block fires; else a block has one azimuth");
  group.number("--blind-from-deg", sensor.blind_from_deg, 0.0, 360.0,
               "A sector without returns, clockwise from this azimuth");
  group.number("--blind-to-deg", sensor.blind_to_deg, 0.0, 720.0, "to this one");
}

void add_robot(CLI::App& command, SimArguments& arguments) {
  command
      .add_option("--robot-box", arguments.robot_boxes_m,
                  "A part of the robot in view: x, y, z from and to, in the sensor's axes; any "
                  "number of them")
      ->delimiter(',')
      ->check(within(-20.0, 20.0))
      ->type_name("X,X,Y,Y,Z,Z")
      ->group("Sensor");
}

void add_clocks(CLI::App& command, SimArguments& arguments) {
  SensorOptions& sensor = arguments.options.sensor;
  FaultOptions& faults = arguments.options.faults;
  Group group(command, "Clocks");
  group.text("--start-utc", arguments.start_utc, "Start of the recording in seconds since 1970");
  group.number("--hour-wrap-at-s", arguments.hour_wrap_at_s, 0.0, 3600.0,
               "A full hour comes so long after the start");
  group.number("--late-hour-wrap-s", sensor.late_hour_wrap_s, 0.0, 1.0,
               "The sensor counts on beyond 3600 s for so long");
  command
      .add_flag_callback(
          "--no-gps", [&sensor] { sensor.gps = false; },
          "No position packets; the sensor's clock runs freely")
      ->group("Clocks");
  group.number("--clock-at-start-s", sensor.clock_at_start_s, 0.0, 3600.0,
               "What the free clock shows at the start");
  group.number("--host-step-at-s", faults.host_step_at_s, 0.0, 7200.0,
               "The capturing computer's clock jumps then");
  group.number("--host-step-s", faults.host_step_s, -1e6, 1e6, "by this");
  group.flag("--pcap-ns", arguments.options.nanosecond_pcap, "Nanosecond stamps in the capture");
}

void add_faults(CLI::App& command, SimOptions& options) {
  FaultOptions& faults = options.faults;
  Group group(command, "Faults");
  group.number("--loss", faults.loss, 0.0, 1.0, "Part of the packets that is lost");
  group.number("--bursts-per-minute", faults.bursts_per_minute, 0.0, 600.0,
               "Losses of many packets in a row");
  group.number("--burst-packets", faults.burst_packets, 1, 100000, "Packets in such a row")
      ->capture_default_str();
  group.number("--duplicates", faults.duplicates, 0.0, 1.0, "Part that arrives twice");
  group.number("--reorder", faults.reorder, 0.0, 1.0, "Part that arrives after the next one");
  group.number("--garbage", faults.garbage, 0.0, 1.0, "Foreign or damaged datagrams per packet");
  group.number("--restart-at-s", faults.restart_at_s, 0.0, 7200.0, "The sensor loses power then");
  group.number("--restart-gap-s", faults.restart_gap_s, 0.0, 600.0, "and is silent for so long")
      ->capture_default_str();
  group.number("--rpm-change-at-s", options.sensor.rpm_change_at_s, 0.0, 7200.0,
               "The motor goes to another speed then, within 2 s");
  group.number("--rpm-after", options.sensor.rpm_after, 0.0, 1200.0, "to this; 0 stops it");
}

std::vector<RobotBox> boxes_of(const std::vector<double>& numbers) {
  constexpr std::size_t kEach = std::tuple_size_v<RobotBox>;
  const auto refuse = [](const std::string& why) {
    throw CLI::ValidationError("--robot-box", why);
  };
  if (numbers.size() % kEach != 0) {
    refuse(fmt::format("expected {} numbers for each box, found {}", kEach, numbers.size()));
  }
  std::vector<RobotBox> boxes(numbers.size() / kEach);
  for (std::size_t k = 0; k < numbers.size(); ++k) boxes[k / kEach][k % kEach] = numbers[k];
  for (const RobotBox& box : boxes) {
    for (std::size_t k = 0; k < kEach; k += 2) {
      if (box[k] < box[k + 1]) continue;
      refuse(fmt::format("expected from below to, found {} and {}", box[k], box[k + 1]));
    }
  }
  return boxes;
}

/// Seconds with up to nine decimals, without the rounding of a double.
std::int64_t parse_utc_ns(const std::string& text) {
  const std::size_t point = text.find('.');
  std::string fraction = point == std::string::npos ? "" : text.substr(point + 1);
  fraction.resize(9, '0');
  const std::string digits = text.substr(0, point) + fraction;
  const bool good = digits.size() > 9 && digits.size() < 20 &&
                    digits.find_first_not_of("0123456789") == std::string::npos;
  if (!good) throw CLI::ValidationError("--start-utc", "expected seconds, found '" + text + "'");
  return std::stoll(digits);
}

}  // namespace

void add_options(CLI::App& command, SimArguments& arguments) {
  command
      .add_option("OUT_DIR", arguments.folder, "Folder to write to, an empty one; made if missing")
      ->required()
      ->type_name("");
  add_motion(command, arguments.options);
  add_sensor(command, arguments.options.sensor);
  add_robot(command, arguments);
  add_clocks(command, arguments);
  add_faults(command, arguments.options);
  command.add_flag(
      "--force", arguments.force,
      "Write to OUT_DIR even if it is not empty; files of the same names are replaced");
  command.add_flag("--quiet", arguments.quiet, "No progress bar");
}

void check_folder(const SimArguments& arguments) {
  const std::filesystem::path folder = arguments.folder;
  if (arguments.force || !std::filesystem::exists(folder)) return;
  if (!std::filesystem::is_directory(folder)) {
    throw CLI::ValidationError("OUT_DIR", arguments.folder + ": expected a folder, found a file");
  }
  if (std::filesystem::is_empty(folder)) return;
  const char* const found = is_made_by_sim(arguments.folder) ? "a recording of lilo sim" : "files";
  throw CLI::ValidationError("OUT_DIR", arguments.folder + ": expected an empty folder, found " +
                                            found + " (--force writes there nevertheless)");
}

void settle(const CLI::App& command, SimArguments& arguments) {
  SimOptions& options = arguments.options;
  SensorOptions& sensor = options.sensor;
  const auto given = [&](const char* name) { return command.count(name) > 0; };
  sensor.robot = boxes_of(arguments.robot_boxes_m);
  for (const WorldInfo& world : known_worlds()) {
    if (world.name == options.world && !given("--speed-mps")) {
      options.motion.speed_mps = world.default_speed_mps;
    }
  }
  const bool hdl64 = sensor.sensor == Sensor::hdl64_s2 || sensor.sensor == Sensor::hdl64_s3;
  if (hdl64 && !given("--range-sigma-m")) sensor.range_sigma_m = 0.018;
  const bool far = hdl64 || sensor.sensor == Sensor::vlp32c || sensor.sensor == Sensor::vls128;
  if (far && !given("--max-range-m")) sensor.max_range_m = 120.0;
  if (sensor.sensor == Sensor::hdl64_s2 && sensor.returns == ReturnMode::dual) {
    throw CLI::ValidationError("--returns", "the HDL-64E S2 has no dual return");
  }
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  if (!arguments.start_utc.empty()) options.start_utc_ns = parse_utc_ns(arguments.start_utc);
  if (arguments.hour_wrap_at_s >= 0.0) {
    const auto ahead_ns = static_cast<std::int64_t>(arguments.hour_wrap_at_s * 1e9);
    options.start_utc_ns = (options.start_utc_ns / kHour_ns + 1) * kHour_ns - ahead_ns;
    if (!sensor.gps) sensor.clock_at_start_s = 3600.0 - arguments.hour_wrap_at_s;
  }
}

}  // namespace lilo::sim
