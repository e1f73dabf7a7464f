// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/saver.hpp"

#include "daemon/metrics_file.hpp"
#include "daemon/realtime.hpp"

#include <boost/asio/post.hpp>

#include <cstdlib>
#include <utility>

namespace lilo {

std::string state_directory(const std::string& configured) {
  if (!configured.empty()) return configured;
  const char* const folders = std::getenv("STATE_DIRECTORY");  // NOLINT(concurrency-mt-unsafe)
  if (folders == nullptr) return "";
  const std::string all = folders;
  return all.substr(0, all.find(':'));  // systemd joins several by colons
}

Saver::~Saver() {
  if (thread_.joinable()) thread_.join();
}

void Saver::write(const std::string& file, std::size_t count, std::function<std::string()> make,
                  SaveDone done) {
  thread_ = std::thread([this, file, count, make = std::move(make), done = std::move(done)] {
    use_normal_policy_in_this_thread();  // not the publisher's, which it would inherit
    const std::error_code error = replace_file(file, make());
    SaveResult result{.error = error ? "cannot write " + file + ": " + error.message() : "",
                      .file = file,
                      .count = count};
    boost::asio::post(io_, [this, result, done] {
      thread_.join();
      done(result);
    });
  });
}

}  // namespace lilo
