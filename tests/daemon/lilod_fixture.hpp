// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/daemon/child_process.hpp"
#include "tests/daemon/sockets.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace lilo {

/// ThreadSanitizer makes a scan take longer than a turn of the sensor, and has memory of its own.
#ifdef __SANITIZE_THREAD__
constexpr bool kUnderTsan = true;
#else
constexpr bool kUnderTsan = false;
#endif
/// With AddressSanitizer it takes longer than a third of a turn.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = kUnderTsan;
#endif

/// A running lilod on free loopback ports, with the test as its sink and as its systemd.
class Lilod {
 public:
  /// `more`: YAML put behind the sections the fixture writes (sensor, udp, publish, subscribe), so
  /// it may hold any other. `environment` is added to ours.
  explicit Lilod(const std::string& more = "",
                 const std::map<std::string, std::string>& environment = {},
                 const std::string& sensor = "model: auto");
  ~Lilod();
  Lilod(const Lilod&) = delete;
  Lilod& operator=(const Lilod&) = delete;

  /// False when it did not say READY=1 in time; its log is then in the test's output.
  [[nodiscard]] bool wait_ready();
  /// kill -9 and another start with the same ports.
  void restart();
  /// Its file with the first `from` replaced by `to`, and SIGHUP.
  void change_config(const std::string& from, const std::string& to);
  /// SIGTERM; the exit code.
  int stop();

  [[nodiscard]] std::uint16_t data_port() const { return data_port_; }
  [[nodiscard]] std::uint16_t position_port() const { return position_port_; }
  [[nodiscard]] std::uint16_t server_port() const { return server_port_; }
  [[nodiscard]] const std::string& config_path() const { return config_path_; }
  UdpSocket& sink() { return sink_; }
  NotifySocket& systemd() { return systemd_; }
  ChildProcess& process() { return *process_; }

 private:
  UdpSocket sink_;
  NotifySocket systemd_;
  std::uint16_t data_port_, position_port_, server_port_;
  std::string config_path_;
  std::map<std::string, std::string> environment_;
  std::unique_ptr<ChildProcess> process_;
};

/// A path of the test's own, of nothing yet.
std::string unique_path(const std::string& name);

/// A file of the test's own, gone with the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace lilo
