// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/prometheus.hpp"

#include "daemon/complaints.hpp"
#include "daemon/pose_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

namespace lilo {
namespace {

/// Lines of Prometheus' text format.
class Metrics {
 public:
  Metrics(std::string& text, std::string_view instance) : text_(text), instance_(instance) {
    text_.clear();
  }

  template <typename Count>
  void counter(const char* name, const char* help, Count value) {
    declare(name, help, "counter");
    sample(name, static_cast<double>(value));
  }
  template <typename Number>
  void gauge(const char* name, const char* help, Number value) {
    declare(name, help, "gauge");
    sample(name, static_cast<double>(value));
  }
  void quantiles(const char* name, const char* help, const Quantiles& ms) {
    declare(name, help, "gauge");
    samples(name, "", ms);
  }
  void stages(const char* name, const char* help, const std::array<Quantiles, kStageCount>& ms) {
    declare(name, help, "gauge");
    for (std::size_t k = 0; k < ms.size(); ++k)
      samples(name, to_string(static_cast<Stage>(k)), ms[k]);
  }
  void policy(const char* name, const char* help, const ThreadPolicy& p) {
    declare(name, help, "gauge");
    fmt::format_to(to(), "{}{{instance=\"{}\",policy=\"{}\",priority=\"{}\",cpus=\"{}\"}} 1\n",
                   name, instance_, p.policy, p.priority, p.cpus);
  }
  void label(const char* name, const char* help, const char* key, std::string_view value) {
    declare(name, help, "gauge");
    labelled(name, key, value, 1);
  }
  // Each of them, with 1 for those that hold now: an alert ends when its complaint does.
  void complaints_of(const Health& h) {
    declare("lilo_complaint", "1: not well in this respect.", "gauge");
    const Complaints now = complaints(h);
    for (std::size_t k = 0; k < kComplaintCount; ++k) {
      const auto complaint = static_cast<Complaint>(k);
      labelled("lilo_complaint", "kind", slug(complaint),
               std::count(now.begin(), now.end(), complaint));
    }
  }

 private:
  std::back_insert_iterator<std::string> to() { return std::back_inserter(text_); }
  void declare(const char* name, const char* help, const char* type) {
    fmt::format_to(to(), "# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
  }
  void sample(const char* name, double value) {
    fmt::format_to(to(), "{}{{instance=\"{}\"}} {:.15g}\n", name, instance_, value);
  }
  void labelled(const char* name, const char* key, std::string_view label, std::ptrdiff_t value) {
    fmt::format_to(to(), "{}{{instance=\"{}\",{}=\"{}\"}} {}\n", name, instance_, key, label,
                   value);
  }
  // `stage` empty: no such label.
  void samples(const char* name, std::string_view stage, const Quantiles& ms) {
    for (const auto& [quantile, value] :
         {std::pair{"0.5", ms.p50}, std::pair{"0.99", ms.p99}, std::pair{"1", ms.max}}) {
      fmt::format_to(to(), "{}{{instance=\"{}\",", name, instance_);
      if (!stage.empty()) fmt::format_to(to(), "stage=\"{}\",", stage);
      fmt::format_to(to(), "quantile=\"{}\"}} {:.6g}\n", quantile, value * 1e-3);
    }
  }
  std::string& text_;
  std::string_view instance_;
};

void write_state(Metrics& m, const std::string& session, const Health& h) {
  m.label("lilo_session_info", "The session that is running.", "session", session);
  m.label("lilo_status_info", "How it is now.", "status", status_word(h));
  m.complaints_of(h);
  m.gauge("lilo_uptime_seconds", "Since the start.", h.uptime_s);
  m.gauge("lilo_pose_rate_hertz", "Poses in the last second.", h.rate_hz);
  if (h.pose_age_s >= 0.0)
    m.gauge("lilo_pose_age_seconds", "Since the last pose was sent.", h.pose_age_s);
  m.gauge("lilo_sensor_silent_seconds", "Since the last packet.", h.sensor_silent_s);
  if (h.sensor.model != SensorModel::automatic) {
    m.label("lilo_sensor_info", "The sensor that is heard.", "model", to_string(h.sensor.model));
    m.gauge("lilo_sensor_rpm", "Revolutions a minute, by its azimuths.", h.sensor.rpm);
  }
  if (h.recent[Fault::wrong_sensor_packets] > 0)
    m.label("lilo_sensor_refused_info", "The sensor whose packets are refused.", "model",
            h.sensor.refused.model_name());
  m.label("lilo_clock_info", "Where the sensor's stamps come from.", "source", to_string(h.clock));
  m.counter("lilo_clock_steps_total", "Times the computer's UTC was set.", h.clock_steps);
}

void write_packets(Metrics& m, const Health& h) {
  const DriverCounts& driver = h.driver;
  m.counter("lilo_packets_received_total", "Data packets used.", driver.data_packets);
  m.counter("lilo_packets_expected_total", "Data packets by the sensor's own stamps.",
            driver.data_packets + driver.packets_lost);
  m.counter("lilo_packets_lost_total", "Data packets that never came.", driver.packets_lost);
  m.counter("lilo_packets_duplicated_total", "Data packets that came again, ignored.",
            driver.packets_duplicated);
  m.counter("lilo_packets_reordered_total", "Data packets that were overtaken.",
            driver.packets_reordered);
  m.counter("lilo_packets_late_total", "Of those overtaken, those too late for their scan.",
            driver.packets_late);
  m.counter("lilo_packets_blind_total", "Never sent, but missed before that was known.",
            driver.packets_blind);
  m.counter("lilo_packets_waiting_total", "Data packets before the calibration was known.",
            driver.waiting_packets);
  m.counter("lilo_packets_position_total", "Packets that tell the time.", driver.position_packets);
  m.counter("lilo_packets_kernel_dropped_total", "Packets the socket had no room for.",
            h.source.kernel_dropped);
  m.counter("lilo_packets_foreign_total", "Packets of a second sensor.", driver.foreign_packets);
  m.counter("lilo_packets_wrong_sensor_total", "Packets of another model, refused.",
            driver.wrong_sensor_packets);
  m.counter("lilo_receive_errors_total", "Failures to read from the sockets.",
            h.source.receive_errors);
  m.counter("lilo_packets_malformed_total", "Packets that are no sensor's.",
            driver.malformed_packets);
  m.counter("lilo_sensor_restarts_total", "Times the sensor's clock jumped.",
            driver.sensor_restarts);
  m.counter("lilo_sensor_stalls_total", "Times its head did not come round.", driver.stalls);
}

void write_scans(Metrics& m, const Health& h) {
  m.counter("lilo_scans_complete_total", "Whole revolutions.", h.driver.scans_complete);
  m.counter("lilo_scans_partial_total", "Revolutions with a hole.", h.driver.scans_partial);
  m.counter("lilo_scans_dropped_total", "Revolutions given up to keep up.", h.scans_dropped);
  m.gauge("lilo_tilt_degrees", "Angle by which scans are levelled; 0: they are not.", h.tilt_deg);
  if (h.has_beams) {
    m.gauge("lilo_beams_elevation_degrees", "Largest correction of a ring's elevation.",
            h.beams_elevation_deg);
    m.gauge("lilo_beams_azimuth_degrees", "Largest correction of an azimuth.", h.beams_azimuth_deg);
  }
  m.counter("lilo_map_refused_total", "Points the full map had no room for.", h.map_refused);
  m.counter("lilo_poses_sent_total", "Poses published.", h.poses_sent);
  m.counter("lilo_poses_not_sent_total", "Poses that could not be.", h.poses_not_sent);
  m.counter("lilo_send_errors_total", "Datagrams the socket refused.", h.send_errors);
  m.gauge("lilo_ring_high_water_scans", "Most scans that ever waited.", h.ring_high_water);
  m.gauge("lilo_clients", "Subscribers.", h.clients);
  m.counter("lilo_clients_refused_total", "Subscriptions beyond the limit.", h.clients_refused);
  m.counter("lilo_packets_sent_total", "Packets passed on to subscribers that record.",
            h.packets_sent);
  m.counter("lilo_packets_not_sent_total", "Those for which there was no room.",
            h.packets_not_sent);
  m.quantiles("lilo_latency_seconds", "Last packet of a revolution to its datagram, last minute.",
              h.latency_ms);
  m.quantiles("lilo_processing_seconds", "Odometry of one scan, last minute.", h.processing_ms);
  m.stages("lilo_stage_seconds", "Stages of the odometry of one scan, last minute.", h.stages_ms);
}

void write_realtime(Metrics& m, const Health& h) {
  m.policy("lilo_worker_policy_info", "Of the worker, read back from the kernel.",
           h.realtime.worker);
  m.gauge("lilo_locked_bytes", "Memory locked.",
          static_cast<double>(h.realtime.locked_memory_kb) * 1024.0);
  m.gauge("lilo_realtime_as_configured", "1: nothing was refused.",
          h.realtime.refusals.empty() ? 1 : 0);
  m.counter("lilo_worker_minor_faults_total", "Page faults of the worker since it was warm.",
            h.worker_minor_faults);
  m.counter("lilo_major_faults_total", "Page faults that waited for a disk, since it was ready.",
            h.major_faults);
  m.gauge("lilo_resident_bytes", "Memory in use.", h.resident_mb * 1048576.0);
}

}  // namespace

void write_prometheus(const std::string& session, const Health& h, std::string& out) {
  Metrics metrics(out, h.instance);
  write_state(metrics, session, h);
  write_packets(metrics, h);
  write_scans(metrics, h);
  write_realtime(metrics, h);
}

}  // namespace lilo
