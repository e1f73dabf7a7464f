// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/container/static_vector.hpp>

#include <string>
#include <string_view>
#include <utility>

namespace lilo {

/// journald's native protocol (systemd.io/JOURNAL_NATIVE_PROTOCOL): one datagram of fields for one
/// entry. By hand and not by libsystemd's sd_journal_send, which waits while journald does not
/// read, and with it would wait the thread that publishes poses. One thread.
class JournalSocket {
 public:
  using Field = std::pair<std::string_view, std::string_view>;
  using Fields = boost::container::static_vector<Field, 12>;

  enum class Sent { yes, full, no };

  /// `path`: of journald's socket. Empty: everything is refused.
  explicit JournalSocket(std::string path);
  ~JournalSocket();
  JournalSocket(const JournalSocket&) = delete;
  JournalSocket& operator=(const JournalSocket&) = delete;

  /// `full`: journald does not read at present, the entry is lost. `no`: there is no journald.
  Sent send(const Fields& fields);

 private:
  int fd_ = -1;
  std::string path_, entry_;
};

/// Where journald listens, if our standard error goes there (JOURNAL_STREAM, systemd.exec(5)), or
/// what LILO_JOURNAL_SOCKET names, for tests; else empty.
std::string journal_socket_path();

}  // namespace lilo
