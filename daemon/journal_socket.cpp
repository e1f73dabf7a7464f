// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/journal_socket.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace lilo {
namespace {

// NAME=value, or where the value has several lines: NAME, its length in 8 bytes, value.
void append(std::string& entry, const JournalSocket::Field& field) {
  const auto& [name, value] = field;
  entry += name;
  if (value.find('\n') == std::string_view::npos) {
    entry += '=';
  } else {
    entry += '\n';
    for (unsigned byte = 0; byte < 8; ++byte)
      entry += static_cast<char>(std::uint64_t{value.size()} >> 8U * byte & 0xffU);
  }
  entry += value;
  entry += '\n';
}

}  // namespace

JournalSocket::JournalSocket(std::string path) : path_(std::move(path)) {
  if (!path_.empty() && path_.size() < sizeof(sockaddr_un::sun_path))
    fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

JournalSocket::~JournalSocket() {
  if (fd_ >= 0) close(fd_);
}

// To the path and not connected: journald may start again.
JournalSocket::Sent JournalSocket::send(const Fields& fields) {
  if (fd_ < 0) return Sent::no;
  entry_.clear();
  for (const Field& field : fields) {
    if (!field.second.empty()) append(entry_, field);
  }
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path_.data(), path_.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path_.size() + 1);
  const ssize_t sent = sendto(fd_, entry_.data(), entry_.size(), MSG_NOSIGNAL,
                              reinterpret_cast<const sockaddr*>(&address), size);
  if (sent >= 0) return Sent::yes;
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS ? Sent::full : Sent::no;
}

std::string journal_socket_path() {
  // The environment is read on the main thread only, and nothing writes it.
  const char* const stand_in = std::getenv("LILO_JOURNAL_SOCKET");  // NOLINT(concurrency-mt-unsafe)
  if (stand_in != nullptr) return stand_in;
  const char* const stream = std::getenv("JOURNAL_STREAM");  // NOLINT(concurrency-mt-unsafe)
  struct stat error {};
  if (stream == nullptr || fstat(STDERR_FILENO, &error) != 0) return "";
  const bool ours = stream == fmt::format("{}:{}", error.st_dev, error.st_ino);
  return ours ? "/run/systemd/journal/socket" : "";
}

}  // namespace lilo
