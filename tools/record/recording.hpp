// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/record/json_lines_file.hpp"
#include "tools/record/mcap_file.hpp"
#include "tools/record/tum_files.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace lilo {

/// What came, and what is known to be missing.
struct RecordCounts {
  std::uint64_t poses = 0, health = 0, missed = 0, sessions = 0;
};

/// Datagrams of a daemon into a file whose ending says how: .jsonl, .tum or .mcap.
class Recording {
 public:
  /// Throws std::runtime_error for another ending, or when the file cannot be written.
  explicit Recording(const std::string& path);

  void take(std::string_view datagram, std::int64_t received_ns);
  void finish();
  [[nodiscard]] const RecordCounts& counts() const { return counts_; }

 private:
  using File = std::variant<JsonLinesFile, TumFiles, McapFile>;
  static File open(const std::string& path);
  void count(const nlohmann::json& message);

  File file_;
  RecordCounts counts_;
  std::string session_;
  std::uint64_t next_seq_ = 0;
};

/// "1234 poses, 123 health reports, 2 missed, 1 session".
std::string to_text(const RecordCounts& counts);

}  // namespace lilo
