// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/lilod_fixture.hpp"

#include "tests/daemon/text_of.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace lilo {

std::string unique_path(const std::string& name) {
  static std::atomic<int> next{0};
  return testing::TempDir() + "lilo_" + std::to_string(getpid()) + '_' + std::to_string(next++) +
         '_' + name;
}

Lilod::Lilod(const std::string& more, const std::map<std::string, std::string>& environment,
             const std::string& sensor)
    : data_port_(free_udp_port()),
      position_port_(free_udp_port()),
      server_port_(free_udp_port()),
      config_path_(unique_path("lilod.yaml")),
      environment_(environment) {
  std::ofstream(config_path_) << "sensor:\n  " << sensor << '\n'
                              << "udp:\n  bind_address: 127.0.0.1\n  data_port: " << data_port_
                              << "\n  position_port: " << position_port_ << '\n'
                              << "publish:\n  sinks: [\"" << sink_.endpoint() << "\"]\n"
                              << "subscribe:\n  port: " << server_port_ << '\n'
                              << more;
  environment_["NOTIFY_SOCKET"] = systemd_.path();
  restart();
}

void Lilod::restart() {
  process_.reset();
  process_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{LILO_BIN_DIR "/lilod", "--config", config_path_}, environment_);
}

Lilod::~Lilod() { std::filesystem::remove(config_path_); }

bool Lilod::wait_ready() {
  const bool ready = systemd_.wait_for("READY=1", std::chrono::seconds(20));
  if (!ready) ADD_FAILURE() << "lilod did not get ready:\n" << process_->standard_error();
  return ready;
}

void Lilod::change_config(const std::string& from, const std::string& to) {
  std::string yaml = text_of(config_path_);
  yaml.replace(yaml.find(from), from.size(), to);
  std::ofstream(config_path_) << yaml;
  process_->signal(SIGHUP);
}

int Lilod::stop() {
  process_->signal(SIGTERM);
  return process_->wait(std::chrono::seconds(20)).value_or(-1);
}

TemporaryFile::TemporaryFile(const std::string& name, const std::string& text)
    : path_(unique_path(name)) {
  std::ofstream(path_, std::ios::binary) << text;
}

TemporaryFile::~TemporaryFile() { std::filesystem::remove(path_); }

}  // namespace lilo
