// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/metrics_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lilo {

std::string metrics_path(const std::string& configured) {
  if (!configured.empty()) return configured;
  const char* const folder = std::getenv("RUNTIME_DIRECTORY");  // NOLINT(concurrency-mt-unsafe)
  return folder == nullptr ? "" : std::string(folder) + "/lilo.prom";
}

namespace {

std::error_code last_error() { return {errno, std::generic_category()}; }

// The draft by O_NONBLOCK and not by waiting for somebody to read a pipe.
int open_draft(const std::string& draft, std::error_code& error) {
  const int fd = open(draft.c_str(),
                      O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_NOCTTY, 0644);
  if (fd < 0) {
    error = last_error();
    return fd;
  }
  struct stat status {};
  if (fstat(fd, &status) == 0 && S_ISREG(status.st_mode) && ftruncate(fd, 0) == 0) return fd;
  error = S_ISREG(status.st_mode) ? last_error() : std::make_error_code(std::errc::not_supported);
  close(fd);
  return -1;
}

std::error_code write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return last_error();
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

}  // namespace

std::error_code replace_file(const std::string& path, std::string_view text) {
  if (path.empty()) return std::make_error_code(std::errc::no_such_file_or_directory);
  const std::string draft = path + ".new";
  std::error_code error;
  const int fd = open_draft(draft, error);
  if (fd < 0) return error;
  // The unit's umask is 0077, but who collects metrics is another user.
  if (fchmod(fd, 0644) != 0) error = last_error();
  if (!error) error = write_all(fd, text);
  if (close(fd) != 0 && !error) error = last_error();
  if (!error && std::rename(draft.c_str(), path.c_str()) != 0) error = last_error();
  if (error) std::remove(draft.c_str());
  return error;
}

}  // namespace lilo
