#include "daemon/service.hpp"

#include "daemon/clock.hpp"
#include "daemon/log.hpp"
#include "daemon/notify.hpp"

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>
#include <unistd.h>
#include <utility>

namespace lilo {
namespace {

using boost::system::error_code;

void log_report(const RealtimeReport& report) {
  const auto log_thread = [](const char* name, const ThreadPolicy& p) {
    spdlog::info("{}: {} priority {}, cpus {}", name, p.policy, p.priority, p.cpus);
  };
  log_thread("worker", report.worker);
  log_thread("receiver", report.receiver);
  spdlog::info("locked memory: {} kB", report.locked_memory_kb);
  for (const std::string& refusal : report.refusals) {
    spdlog::warn("NOT real time as configured: {}", refusal);
  }
}

std::uint64_t dropped(const PipelineCounters& c) { return c.scans_overrun + c.scans_skipped; }

}  // namespace

Service::Service(const Config& config, std::string config_path)
    : config_(config),
      config_path_(std::move(config_path)),
      signals_(io_, SIGINT, SIGTERM, SIGHUP),
      second_(io_),
      watchdog_(io_),
      sinks_(io_),
      engine_(config, open_udp(config.udp)),
      report_ready_(io_, dup(engine_.report_ready().fd())),
      message_{new_session(), config.publish.frame_id, config.publish.child_frame_id} {
  sinks_.set(config.publish.sinks);
  // OpenCV's pool would inherit the worker's core and policy, and fight it for both.
  cv::setNumThreads(1);
}

void Service::run() {
  log_report(engine_.start());
  spdlog::info("session {}: listening on {}:{}, {} sink(s)", message_.session,
               config_.udp.bind_address, config_.udp.data_port, config_.publish.sinks.size());
  await_signal();
  await_reports();
  await_second();
  const std::int64_t watchdog_us = notify::watchdog_interval_us();
  if (watchdog_us > 0) await_watchdog(watchdog_us / 2);
  notify::ready("waiting for the sensor");
  io_.run();
  notify::stopping();
  engine_.stop();
  publish_poses();
  spdlog::info("{} poses published, {} scans dropped", poses_, dropped(engine_.counters()));
}

void Service::await_reports() {
  report_ready_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                           [this](const error_code& error) {
                             if (error) return;
                             engine_.report_ready().wait();
                             publish_poses();
                             await_reports();
                           });
}

void Service::publish_poses() {
  ReportRing& reports = engine_.reports();
  while (const PoseReport* report = reports.front()) {
    const std::string_view datagram = write_pose(message_, *report, monotonic_ns(), json_);
    if (datagram.empty()) {
      ++not_finite_;
    } else {
      sinks_.send(datagram);
      ++poses_;
    }
    status_ = report->estimate.status;
    reports.release();
  }
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

void Service::reload() { spdlog::warn("{}: reload is not supported yet", config_path_); }

void Service::await_second() {
  second_.expires_after(std::chrono::seconds(1));
  second_.async_wait([this](const error_code& error) {
    if (error) return;
    supervise();
    await_second();
  });
}

// Once a second: the state in words for `systemctl status`, and new problems for the log.
void Service::supervise() {
  const PipelineCounters& counters = engine_.counters();
  const DriverCounts driver = engine_.receiver().driver_counts().driver();
  const SourceCounts source = engine_.receiver().driver_counts().source();
  const std::uint64_t rate = poses_ - poses_a_second_ago_;
  poses_a_second_ago_ = poses_;
  const std::string words =
      rate > 0 ? fmt::format("{} {} Hz, packets lost {}, scans dropped {}", to_string(status_),
                             rate, driver.packets_lost, dropped(counters))
               : fmt::format("no scans; {} packets so far", driver.data_packets);
  notify::status(words);

  const std::uint64_t problems = driver.packets_lost + driver.malformed_packets +
                                 source.kernel_dropped + dropped(counters) + not_finite_ +
                                 counters.reports_dropped + sinks_.send_errors();
  if (problems == problems_logged_) return;
  problems_logged_ = problems;
  spdlog::warn(
      "packets lost {} (by the kernel {}), malformed {}; scans dropped {}; poses not sent {}; send "
      "errors {}",
      driver.packets_lost, source.kernel_dropped, driver.malformed_packets, dropped(counters),
      counters.reports_dropped + not_finite_, sinks_.send_errors());
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
