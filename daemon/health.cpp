#include "daemon/health.hpp"

#include "daemon/pose_message.hpp"

#include <fmt/format.h>

#include <iterator>
#include <utility>

namespace lilo {
namespace {

constexpr double kSilentAfterS = 1.0;

void write_quantiles(JsonWriter& out, std::string_view name, const Quantiles& q) {
  out.begin_object(name);
  out.number("p50", q.p50, 2);
  out.number("p99", q.p99, 2);
  out.number("max", q.max, 2);
  out.end_object();
}

void write_packets(JsonWriter& out, const Health& h) {
  out.begin_object("packets");
  out.unsigned_integer("received", h.driver.data_packets);
  out.unsigned_integer("lost", h.driver.packets_lost);
  out.unsigned_integer("kernel_dropped", h.source.kernel_dropped);
  out.unsigned_integer("malformed", h.driver.malformed_packets);
  out.unsigned_integer("duplicated", h.driver.packets_duplicated);
  out.unsigned_integer("reordered", h.driver.packets_reordered);
  out.end_object();
}

void write_scans(JsonWriter& out, const Health& h) {
  out.begin_object("scans");
  out.unsigned_integer("complete", h.driver.scans_complete);
  out.unsigned_integer("partial", h.driver.scans_partial);
  out.unsigned_integer("processed", h.scans_processed);
  out.unsigned_integer("dropped", h.scans_dropped);
  out.unsigned_integer("ring_high_water", h.ring_high_water);
  out.unsigned_integer("ring_slots", h.ring_slots);
  out.end_object();
}

void write_realtime(JsonWriter& out, const Health& h) {
  out.begin_object("realtime");
  out.boolean("as_configured", h.realtime.refusals.empty());
  out.text("policy", h.realtime.worker.policy);
  out.integer("priority", h.realtime.worker.priority);
  out.text("cpus", h.realtime.worker.cpus);
  out.integer("locked_kb", h.realtime.locked_memory_kb);
  out.unsigned_integer("worker_minor_faults", h.worker_minor_faults);
  out.unsigned_integer("major_faults", h.major_faults);
  out.number("resident_mb", h.resident_mb, 1);
  out.end_object();
}

std::string_view write(const std::string& session, const Health& h, bool with_stages,
                       JsonWriter& out) {
  out = JsonWriter();
  out.text("v", kProtocolVersion);
  out.seconds("timestamp", h.stamp_ns);
  out.text("session", session);
  out.begin_object("health");
  out.text("status", to_string(h.status));
  out.begin_array("complaints");
  for (const std::string_view complaint : complaints(h)) out.item(complaint);
  out.end_array();
  out.number("uptime_s", h.uptime_s, 1);
  out.number("rate_hz", h.rate_hz, 1);
  out.text("clock", to_string(h.clock));
  out.number("sensor_silent_s", h.sensor_silent_s, 1);
  write_packets(out, h);
  write_scans(out, h);
  out.unsigned_integer("map_refused", h.map_refused);
  out.unsigned_integer("poses_sent", h.poses_sent);
  out.unsigned_integer("poses_not_sent", h.poses_not_sent);
  out.unsigned_integer("send_errors", h.send_errors);
  out.unsigned_integer("receive_errors", h.source.receive_errors);
  out.unsigned_integer("clients", h.clients);
  write_quantiles(out, "latency_ms", h.latency_ms);
  write_quantiles(out, "processing_ms", h.processing_ms);
  write_realtime(out, h);
  if (with_stages) {
    out.begin_object("stages_ms");
    for (std::size_t k = 0; k < h.stages_ms.size(); ++k)
      out.number(to_string(static_cast<Stage>(k)), h.stages_ms[k].p50, 2);
    out.end_object();
  }
  out.end_object();
  return out.finish();
}

/// Lines of Prometheus' text format.
class Metrics {
 public:
  explicit Metrics(std::string& text) : text_(text) { text_.clear(); }

  void counter(const char* name, const char* help, double value) {
    add(name, help, "counter", value);
  }
  void gauge(const char* name, const char* help, double value) { add(name, help, "gauge", value); }
  void quantiles(const char* name, const char* help, const Quantiles& ms) {
    declare(name, help);
    samples(name, "", ms);
  }
  void stages(const char* name, const char* help, const std::array<Quantiles, kStageCount>& ms) {
    declare(name, help);
    for (std::size_t k = 0; k < ms.size(); ++k)
      samples(name, to_string(static_cast<Stage>(k)), ms[k]);
  }
  void policy(const char* name, const char* help, const ThreadPolicy& p) {
    declare(name, help);
    fmt::format_to(to(), "{}{{policy=\"{}\",priority=\"{}\",cpus=\"{}\"}} 1\n", name, p.policy,
                   p.priority, p.cpus);
  }
  void label(const char* name, const char* help, const char* key, std::string_view value) {
    fmt::format_to(to(), "# HELP {} {}\n# TYPE {} gauge\n{}{{{}=\"{}\"}} 1\n", name, help, name,
                   name, key, value);
  }

 private:
  std::back_insert_iterator<std::string> to() { return std::back_inserter(text_); }
  void declare(const char* name, const char* help) {
    fmt::format_to(to(), "# HELP {} {}\n# TYPE {} gauge\n", name, help, name);
  }
  // `stage` empty: no such label.
  void samples(const char* name, std::string_view stage, const Quantiles& ms) {
    for (const auto& [quantile, value] :
         {std::pair{"0.5", ms.p50}, std::pair{"0.99", ms.p99}, std::pair{"1", ms.max}}) {
      fmt::format_to(to(), "{}{{", name);
      if (!stage.empty()) fmt::format_to(to(), "stage=\"{}\",", stage);
      fmt::format_to(to(), "quantile=\"{}\"}} {:.6g}\n", quantile, value * 1e-3);
    }
  }
  void add(const char* name, const char* help, const char* type, double value) {
    fmt::format_to(to(), "# HELP {} {}\n# TYPE {} {}\n{} {:.15g}\n", name, help, name, type, name,
                   value);
  }
  std::string& text_;
};

}  // namespace

const char* to_string(ClockSource clock) {
  switch (clock) {
    case ClockSource::host:
      return "host";
    case ClockSource::gps:
      return "gps";
    case ClockSource::replay:
      return "replay";
  }
  return "host";
}

Complaints complaints(const Health& h) {
  Complaints out;
  if (h.sensor_silent_s > kSilentAfterS) out.emplace_back("sensor silent");
  if (h.calibration_progress < 1.0) out.emplace_back("waiting for the calibration");
  if (h.status == TrackingStatus::lost) out.emplace_back("lost");
  if (h.status == TrackingStatus::degraded) out.emplace_back("degraded");
  if (h.driver.packets_lost > 0) out.emplace_back("packets lost");
  if (h.source.receive_errors > 0) out.emplace_back("receive errors");
  if (h.scans_dropped > 0) out.emplace_back("scans dropped");
  if (h.map_refused > 0) out.emplace_back("map full");
  if (!h.realtime.refusals.empty()) out.emplace_back("real time refused");
  if (h.config_error) out.emplace_back("configuration file bad");
  if (h.metrics_error) out.emplace_back("metrics file not written");
  return out;
}

std::string_view write_health(const std::string& session, const Health& health, JsonWriter& out) {
  const std::string_view whole = write(session, health, true, out);
  return whole.empty() ? write(session, health, false, out) : whole;
}

void write_prometheus(const std::string& session, const Health& h, std::string& out) {
  const auto d = [](auto count) { return static_cast<double>(count); };
  Metrics m(out);
  m.label("lilo_session_info", "The session that is running.", "session", session);
  m.label("lilo_status_info", "Tracking status.", "status", to_string(h.status));
  m.gauge("lilo_uptime_seconds", "Since the start.", h.uptime_s);
  m.gauge("lilo_pose_rate_hertz", "Poses in the last second.", h.rate_hz);
  m.gauge("lilo_sensor_silent_seconds", "Since the last packet.", h.sensor_silent_s);
  m.counter("lilo_packets_received_total", "Data packets used.", d(h.driver.data_packets));
  m.counter("lilo_packets_expected_total", "Data packets by the sensor's own stamps.",
            d(h.driver.data_packets + h.driver.packets_lost));
  m.counter("lilo_packets_lost_total", "Data packets that never came.", d(h.driver.packets_lost));
  m.counter("lilo_packets_kernel_dropped_total", "Packets the socket had no room for.",
            d(h.source.kernel_dropped));
  m.counter("lilo_receive_errors_total", "Failures to read from the sockets.",
            d(h.source.receive_errors));
  m.counter("lilo_packets_malformed_total", "Packets that are no sensor's.",
            d(h.driver.malformed_packets));
  m.counter("lilo_scans_complete_total", "Whole revolutions.", d(h.driver.scans_complete));
  m.counter("lilo_scans_partial_total", "Revolutions with a hole.", d(h.driver.scans_partial));
  m.counter("lilo_scans_dropped_total", "Revolutions given up to keep up.", d(h.scans_dropped));
  m.counter("lilo_map_refused_total", "Points the full map had no room for.", d(h.map_refused));
  m.counter("lilo_poses_sent_total", "Poses published.", d(h.poses_sent));
  m.counter("lilo_poses_not_sent_total", "Poses that could not be.", d(h.poses_not_sent));
  m.counter("lilo_send_errors_total", "Datagrams the socket refused.", d(h.send_errors));
  m.gauge("lilo_ring_high_water_scans", "Most scans that ever waited.", d(h.ring_high_water));
  m.gauge("lilo_clients", "Subscribers.", d(h.clients));
  m.quantiles("lilo_latency_seconds", "Last packet of a revolution to its datagram, last minute.",
              h.latency_ms);
  m.quantiles("lilo_processing_seconds", "Odometry of one scan, last minute.", h.processing_ms);
  m.stages("lilo_stage_seconds", "Stages of the odometry of one scan, last minute.", h.stages_ms);
  m.label("lilo_clock_info", "Where the sensor's stamps come from.", "source", to_string(h.clock));
  m.policy("lilo_worker_policy_info", "Of the worker, read back from the kernel.",
           h.realtime.worker);
  m.gauge("lilo_locked_bytes", "Memory locked.", d(h.realtime.locked_memory_kb) * 1024.0);
  m.gauge("lilo_realtime_as_configured", "1: nothing was refused.",
          h.realtime.refusals.empty() ? 1.0 : 0.0);
  m.counter("lilo_worker_minor_faults_total", "Page faults of the worker since it was warm.",
            d(h.worker_minor_faults));
  m.counter("lilo_major_faults_total", "Page faults that waited for a disk, since it was ready.",
            d(h.major_faults));
  m.gauge("lilo_resident_bytes", "Memory in use.", h.resident_mb * 1048576.0);
}

}  // namespace lilo
