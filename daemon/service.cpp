// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service.hpp"

#include "config/key.hpp"
#include "daemon/clock.hpp"
#include "daemon/complaints.hpp"
#include "daemon/log.hpp"
#include "daemon/notify.hpp"
#include "daemon/pose_message.hpp"
#include "daemon/saver.hpp"
#include "daemon/stop_deadline.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <iterator>
#include <sstream>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace lilo {
namespace {

using boost::system::error_code;

constexpr unsigned kStopWithinS = 4;  // the unit's TimeoutStopSec= is 5 s

void log_report(const RealtimeReport& report) {
  const auto log_thread = [](const char* name, const ThreadPolicy& p) {
    spdlog::info("{}: {} priority {}, cpus {}", name, p.policy, p.priority, p.cpus);
  };
  log_thread("worker", report.worker);
  log_thread("receiver", report.receiver);
  log_thread("publisher", report.publisher);
  spdlog::info("locked memory: {} kB", report.locked_memory_kb);
  for (const std::string& refusal : report.refusals)
    log_event(Event::realtime_refused, fmt::format("NOT real time as configured: {}", refusal));
}

// In place of what `out` held, whose memory it keeps.
void in_words(const Health& h, std::string& out) {
  out.clear();
  const auto to = std::back_inserter(out);
  if (h.flow != Flow::no_packets && waits_for_calibration(h.sensor)) {
    fmt::format_to(to, "waiting for the calibration in the sensor's packets, {:.0f} %",
                   100.0 * h.sensor.calibration_progress);
  } else if (h.source.packets == 0) {
    out += "waiting for the sensor";
  } else if (h.flow == Flow::no_packets) {
    fmt::format_to(to, "sensor silent for {:.0f} s", h.sensor_silent_s);
  } else if (h.flow == Flow::all) {
    fmt::format_to(to, "{} {:.0f} Hz, packets lost {}, scans dropped {}", to_string(h.tracking),
                   h.rate_hz, h.driver.packets_lost, h.scans_dropped);
  } else {
    for (const Complaint complaint : complaints(h)) {
      if (!out.empty()) out += ", ";
      out += words(complaint);
    }
  }
}

}  // namespace

Service::Service(const Config& config, std::string config_path)
    : config_(config),
      config_path_(std::move(config_path)),
      signals_(io_, SIGINT, SIGTERM, SIGHUP),
      second_(io_),
      watchdog_(io_),
      engine_(config, open_udp(config.udp)),
      monitor_(engine_, instance_name(config_path_)),
      publisher_(io_, config, engine_, monitor_, story_),
      calibration_keeper_(io_, engine_.receiver(), state_directory(config.state.directory)),
      beam_keeper_(io_, engine_.beams(), state_directory(config.state.directory)),
      report_ready_(io_, dup(engine_.report_ready().fd())) {}

void Service::run() {
  const RealtimeReport report = engine_.start();
  log_report(report);
  monitor_.started(report);
  set_log_context(publisher_.session(), "initializing");
  log_event(Event::started, fmt::format("session {}: listening on {}:{}, {} sink(s)",
                                        publisher_.session(), config_.udp.bind_address,
                                        config_.udp.data_port, config_.publish.sinks.size()));
  check_state_directory();
  await_signal();
  await_reports();
  await_second();
  const std::int64_t watchdog_us = notify::watchdog_interval_us();
  if (watchdog_us > 0) await_watchdog(watchdog_us / 2);
  publisher_.tick();  // so that there is a health to be asked for
  notify::ready("waiting for the sensor");
  io_.run();
  notify::stopping();
  start_stop_deadline(kStopWithinS);
  engine_.stop();
  publisher_.take_reports();
  publisher_.tick();
  const Health& h = publisher_.last_health();
  log_event(Event::stopping, fmt::format("{} poses published, {} packets lost, {} scans dropped",
                                         h.poses_sent, h.driver.packets_lost, h.scans_dropped));
  beam_keeper_.finish();  // last: a disk may be slow
}

// What cannot be kept there is a pity, not a reason to stand still.
void Service::check_state_directory() {
  const std::string directory = state_directory(config_.state.directory);
  if (directory.empty() || access(directory.c_str(), R_OK | W_OK | X_OK) == 0) return;
  log_event(Event::not_saved, fmt::format("nothing can be saved: state directory {}: {}", directory,
                                          std::generic_category().message(errno)));
}

void Service::await_reports() {
  report_ready_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                           [this](const error_code& error) {
                             if (error) return;
                             engine_.report_ready().wait();
                             publisher_.take_reports();
                             await_reports();
                           });
}

void Service::await_signal() {
  signals_.async_wait([this](const error_code& error, int signal) {
    if (error) return;
    if (signal != SIGHUP) {
      spdlog::info("stopping on signal {}", signal);
      io_.stop();
      return;
    }
    reload();
    await_signal();
  });
}

// A bad file changes nothing.
void Service::reload() {
  notify::reloading();
  try {
    // Without a key it is a file that is being written, or was emptied by mistake.
    apply(load_config(config_path_, EmptyFile::refused));
    monitor_.config_was_bad(false);
  } catch (const ConfigError& error) {
    monitor_.config_was_bad(true);
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) log_event(Event::config_refused, line);
    spdlog::error("the configuration in force stays");
  }
  notify::ready(status_);
}

// What can change does; what cannot is named, and stays as it was.
void Service::apply(const Config& read) {
  const std::vector<Key> keys = config_keys();
  const std::vector<const Key*> differing = differing_keys(keys, read, config_);
  for (const Key* key : differing) {
    const std::string value = to_yaml(key->get(read));
    if (key->reload == Reload::live) {
      key->set(config_, key->get(read));
      spdlog::info("{} is now {}", key->path, value);
    } else {
      spdlog::warn("{}: {} needs a restart", key->path, value);
    }
  }
  publisher_.configure(config_);
  set_log_level(config_.log.level);
  log_event(Event::config_taken,
            fmt::format("{} read again, {} key(s) differ", config_path_, differing.size()));
}

void Service::await_second() {
  second_.expires_after(std::chrono::seconds(1));
  second_.async_wait([this](const error_code& error) {
    if (error) return;
    supervise();
    await_second();
  });
}

// Health for the clients, the state in words for `systemctl status`, what changed for the journal.
void Service::supervise() {
  publisher_.tick();
  const Health& h = publisher_.last_health();
  set_log_context(publisher_.session(), status_word(h));
  in_words(h, new_status_);
  if (new_status_ != status_) {
    notify::status(new_status_);
    spdlog::debug("{}", new_status_);
  }
  std::swap(status_, new_status_);
  story_.second(h);
  calibration_keeper_.look();
  beam_keeper_.look();
}

void Service::await_watchdog(std::int64_t interval_us) {
  watchdog_.expires_after(std::chrono::microseconds(interval_us));
  watchdog_.async_wait([this, interval_us](const error_code& error) {
    if (error) return;
    if (worker_is_alive()) notify::watchdog();
    await_watchdog(interval_us);
  });
}

// Since the last look it finished a scan, or there is none for it to work on.
bool Service::worker_is_alive() {
  const std::uint64_t processed = engine_.counters().scans_processed;
  const bool progress = processed != processed_at_last_look_;
  processed_at_last_look_ = processed;
  return progress || engine_.scans_waiting() == 0;
}

}  // namespace lilo
