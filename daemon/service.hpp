// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "daemon/beam_keeper.hpp"
#include "daemon/calibration_keeper.hpp"
#include "daemon/engine.hpp"
#include "daemon/health_monitor.hpp"
#include "daemon/publisher.hpp"
#include "daemon/story.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include <cstdint>
#include <string>

namespace lilo {

/// The daemon: an engine, and the main thread as its publisher and supervisor.
class Service {
 public:
  /// Binds the sockets and reserves the memory. Throws DriverError and std::runtime_error.
  Service(const Config& config, std::string config_path);

  /// Until SIGINT or SIGTERM. SIGHUP reads the configuration again.
  void run();

 private:
  void await_reports();
  void await_signal();
  void await_second();
  void await_watchdog(std::int64_t interval_us);
  void supervise();
  void check_state_directory();
  void reload();
  void apply(const Config& read);
  [[nodiscard]] bool worker_is_alive();

  Config config_;  // in force
  std::string config_path_;
  boost::asio::io_context io_{1};
  boost::asio::signal_set signals_;
  boost::asio::steady_timer second_, watchdog_;
  Engine engine_;
  HealthMonitor monitor_;
  Story story_;
  Publisher publisher_;
  CalibrationKeeper calibration_keeper_;
  BeamKeeper beam_keeper_;
  boost::asio::posix::stream_descriptor report_ready_;

  std::string status_, new_status_;
  std::uint64_t processed_at_last_look_ = 0;
};

}  // namespace lilo
