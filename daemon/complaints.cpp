#include "daemon/complaints.hpp"

#include <array>

namespace lilo {
namespace {

struct Name {
  std::string_view slug, words;
};

constexpr std::array<Name, kComplaintCount> kNames{{
    {"sensor_silent", "sensor silent"},
    {"no_scans", "no scans although packets come"},
    {"no_poses", "no poses although scans come"},
    {"waiting_for_calibration", "waiting for the calibration"},
    {"lost", "lost"},
    {"degraded", "degraded"},
    {"second_sensor", "packets of a second sensor ignored"},
    {"packets_lost", "packets lost"},
    {"kernel_dropped", "packets dropped by the kernel"},
    {"malformed_packets", "malformed packets"},
    {"receive_errors", "receive errors"},
    {"sensor_restarted", "the sensor's clock jumped"},
    {"scans_dropped", "scans dropped"},
    {"map_full", "map full"},
    {"poses_not_sent", "poses not sent"},
    {"send_errors", "send errors"},
    {"clock_stepped", "the computer's clock was set"},
    {"realtime_refused", "real time refused"},
    {"config_bad", "configuration file bad"},
    {"metrics_not_written", "metrics file not written"},
}};

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

// In the order of Fault.
constexpr std::array<Complaint, kFaultCount> kOfFaults{
    Complaint::packets_lost,  Complaint::kernel_dropped, Complaint::malformed_packets,
    Complaint::second_sensor, Complaint::receive_errors, Complaint::sensor_restarted,
    Complaint::scans_dropped, Complaint::map_full,       Complaint::poses_not_sent,
    Complaint::send_errors,   Complaint::clock_stepped};

}  // namespace

Complaints complaints(const Health& h) {
  Complaints out;
  add_flow(h, out);
  for (std::size_t k = 0; k < kFaultCount; ++k)
    if (h.recent.counts[k] > 0) out.push_back(kOfFaults[k]);
  if (!h.realtime.refusals.empty()) out.push_back(Complaint::realtime_refused);
  if (h.config_error) out.push_back(Complaint::config_bad);
  if (h.metrics_error) out.push_back(Complaint::metrics_not_written);
  return out;
}

Complaint complaint_of(Fault fault) { return kOfFaults[static_cast<std::size_t>(fault)]; }

std::string_view words(Complaint complaint) { return name_of(complaint).words; }
std::string_view slug(Complaint complaint) { return name_of(complaint).slug; }

}  // namespace lilo
