// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/recording.hpp"

#include "tools/message_numbers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <stdexcept>

namespace lilo {

Recording::File Recording::open(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".jsonl" || ending == ".json") return File(JsonLinesFile(path));
  if (ending == ".tum" || ending == ".txt") return File(TumFiles(path));
  if (ending == ".mcap") return File(McapFile(path));
  throw std::runtime_error(fmt::format(
      "{}: expected a name that ends in .jsonl, .tum or .mcap, found \"{}\"", path, ending));
}

Recording::Recording(const std::string& path) : file_(open(path)) {}

void Recording::take(std::string_view datagram, std::int64_t received_ns) {
  const nlohmann::json message = nlohmann::json::parse(datagram, nullptr, false);
  if (!message.is_object()) return;
  count(message);
  std::visit([&](auto& file) { file.take(datagram, message, received_ns); }, file_);
}

void Recording::count(const nlohmann::json& message) {
  counts_.health += message.contains("health") ? 1 : 0;
  if (!message.contains("pose")) return;
  ++counts_.poses;
  const std::string session = message.value("session", "");
  const std::uint64_t seq = count_in(message, "seq");
  if (session != session_ || counts_.sessions == 0) {
    ++counts_.sessions;
  } else if (seq > next_seq_) {
    counts_.missed += seq - next_seq_;
  }
  session_ = session;
  next_seq_ = seq + 1;
}

void Recording::finish() {
  std::visit([](auto& file) { file.finish(); }, file_);
}

std::string to_text(const RecordCounts& counts) {
  return fmt::format("{} poses, {} health reports, {} missed, {} session{}", counts.poses,
                     counts.health, counts.missed, counts.sessions,
                     counts.sessions == 1 ? "" : "s");
}

}  // namespace lilo
