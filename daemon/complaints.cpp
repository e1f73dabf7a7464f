// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/complaints.hpp"

#include "drivers/sensor_identity.hpp"
#include "drivers/sensor_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace lilo {
namespace {

struct Name {
  Complaint complaint;
  std::string_view slug, words;
};

constexpr std::array<Name, kComplaintCount> kNames{{
    {Complaint::sensor_silent, "sensor_silent", "sensor silent"},
    {Complaint::no_scans, "no_scans", "no scans although packets come"},
    {Complaint::no_poses, "no_poses", "no poses although scans come"},
    {Complaint::waiting_for_calibration, "waiting_for_calibration", "waiting for the calibration"},
    {Complaint::lost, "lost", "lost"},
    {Complaint::degraded, "degraded", "degraded"},
    {Complaint::wrong_sensor, "wrong_sensor", "packets of another model refused"},
    {Complaint::second_sensor, "second_sensor", "packets of a second sensor ignored"},
    {Complaint::packets_lost, "packets_lost", "packets lost"},
    {Complaint::kernel_dropped, "kernel_dropped", "packets dropped by the kernel"},
    {Complaint::malformed_packets, "malformed_packets", "malformed packets"},
    {Complaint::receive_errors, "receive_errors", "receive errors"},
    {Complaint::sensor_restarted, "sensor_restarted", "the sensor's clock jumped"},
    {Complaint::scans_dropped, "scans_dropped", "scans dropped"},
    {Complaint::map_full, "map_full", "map full"},
    {Complaint::poses_not_sent, "poses_not_sent", "poses not sent"},
    {Complaint::send_errors, "send_errors", "send errors"},
    {Complaint::clock_stepped, "clock_stepped", "the computer's clock was set"},
    {Complaint::realtime_refused, "realtime_refused", "real time refused"},
    {Complaint::config_bad, "config_bad", "configuration file bad"},
    {Complaint::metrics_not_written, "metrics_not_written", "metrics file not written"},
}};

/// A count that is a fault, and what is said of it.
struct CountedFault {
  Fault fault;
  Complaint complaint;
  std::uint64_t (*total)(const Health& h);
};

constexpr std::array<CountedFault, kFaultCount> kFaults{{
    {Fault::wrong_sensor_packets, Complaint::wrong_sensor,
     [](const Health& h) { return h.driver.wrong_sensor_packets; }},
    {Fault::foreign_packets, Complaint::second_sensor,
     [](const Health& h) { return h.driver.foreign_packets; }},
    {Fault::packets_lost, Complaint::packets_lost,
     [](const Health& h) { return h.driver.packets_lost; }},
    {Fault::kernel_dropped, Complaint::kernel_dropped,
     [](const Health& h) { return h.source.kernel_dropped; }},
    {Fault::malformed_packets, Complaint::malformed_packets,
     [](const Health& h) { return h.driver.malformed_packets; }},
    {Fault::receive_errors, Complaint::receive_errors,
     [](const Health& h) { return h.source.receive_errors; }},
    {Fault::sensor_restarts, Complaint::sensor_restarted,
     [](const Health& h) { return h.driver.sensor_restarts; }},
    {Fault::scans_dropped, Complaint::scans_dropped,
     [](const Health& h) { return h.scans_dropped; }},
    {Fault::map_refused, Complaint::map_full, [](const Health& h) { return h.map_refused; }},
    {Fault::poses_not_sent, Complaint::poses_not_sent,
     [](const Health& h) { return h.poses_not_sent; }},
    {Fault::send_errors, Complaint::send_errors, [](const Health& h) { return h.send_errors; }},
    {Fault::clock_steps, Complaint::clock_stepped, [](const Health& h) { return h.clock_steps; }},
}};

// A row that is missing or out of place does not compile.
static_assert([] {
  for (std::size_t k = 0; k < kComplaintCount; ++k)
    if (kNames[k].complaint != static_cast<Complaint>(k)) return false;
  for (std::size_t k = 0; k < kFaultCount; ++k)
    if (kFaults[k].fault != static_cast<Fault>(k)) return false;
  return true;
}());

const Name& name_of(Complaint complaint) { return kNames[static_cast<std::size_t>(complaint)]; }

// What does not come through. While nothing does, what the last pose said is past.
void add_flow(const Health& h, Complaints& out) {
  const bool waiting = waits_for_calibration(h.sensor);
  if (h.flow == Flow::no_packets) out.push_back(Complaint::sensor_silent);
  if (h.flow == Flow::no_scans && !waiting) out.push_back(Complaint::no_scans);
  if (h.flow == Flow::no_poses) out.push_back(Complaint::no_poses);
  if (h.flow != Flow::no_packets && waiting) out.push_back(Complaint::waiting_for_calibration);
  if (h.flow != Flow::all) return;
  if (h.tracking == TrackingStatus::lost) out.push_back(Complaint::lost);
  if (h.tracking == TrackingStatus::degraded) out.push_back(Complaint::degraded);
}

// "a VLP-16", "an HDL-64E": H is said with a vowel.
std::string_view article(std::string_view name) {
  return name.starts_with('H') || name.starts_with('u') ? "an" : "a";
}

/// The end of a sentence: "refused, configured is ", "VLP-16", ": set sensor.model".
struct Cure {
  std::string_view before, name, after;
};

// An unknown byte may be that of old firmware, which leaves it to chance.
Cure cure_of(const SensorStatus& sensor) {
  const RefusedSensor& refused = sensor.refused;
  if (refused.model == SensorModel::automatic && is_product(refused.product_id))
    return {"refused: ", "lilod cannot read them", ""};
  if (const SensorTable* configured = find_sensor(sensor.configured))
    return {"refused, configured is ", configured->name, ": set sensor.model"};
  if (const SensorTable* followed = find_sensor(sensor.model)) {
    const bool vowel = article(followed->name) == "an";
    return {vowel ? "refused, an " : "refused, a ", followed->name,
            " is followed: use another port"};
  }
  return {"refused: ", "set sensor.model", ""};
}

std::string_view write_wrong_sensor(const SensorStatus& sensor, WordsBuffer& buffer) {
  const RefusedSensor& refused = sensor.refused;
  const std::string_view name = refused.model_name();
  const Cure cure = cure_of(sensor);
  std::array<char, 24> byte{};  // an HDL-64E has none
  if (refused.product_id != 0)
    fmt::format_to_n(byte.data(), byte.size() - 1, "(product byte 0x{:02X}) ", refused.product_id);
  const auto written =
      fmt::format_to_n(buffer.data(), buffer.size(), "packets of {} {} {}{}{}{}", article(name),
                       name, byte.data(), cure.before, cure.name, cure.after);
  return {buffer.data(), std::min(written.size, buffer.size())};
}

}  // namespace

Complaints complaints(const Health& h) {
  Complaints out;
  add_flow(h, out);
  for (const CountedFault& row : kFaults)
    if (h.recent[row.fault] > 0) out.push_back(row.complaint);
  if (!h.realtime.refusals.empty()) out.push_back(Complaint::realtime_refused);
  if (h.config_error) out.push_back(Complaint::config_bad);
  if (h.metrics_error) out.push_back(Complaint::metrics_not_written);
  return out;
}

Complaint complaint_of(Fault fault) { return kFaults[static_cast<std::size_t>(fault)].complaint; }

FaultCounts fault_totals(const Health& h) {
  FaultCounts out;
  for (const CountedFault& row : kFaults) out[row.fault] = row.total(h);
  return out;
}

std::string_view words(Complaint complaint) { return name_of(complaint).words; }

std::string_view words(Complaint complaint, const Health& h, WordsBuffer& buffer) {
  const bool named = complaint == Complaint::wrong_sensor && h.sensor.refused.packets > 0;
  return named ? write_wrong_sensor(h.sensor, buffer) : words(complaint);
}

std::string_view slug(Complaint complaint) { return name_of(complaint).slug; }

}  // namespace lilo
