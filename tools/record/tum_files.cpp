// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/tum_files.hpp"

#include "tools/listen/pose_message.hpp"
#include "tools/text_file.hpp"
#include "tools/trajectory.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <utility>

namespace lilo {

TumFiles::TumFiles(std::string path) : path_(std::move(path)) { begin_next_file(); }

void TumFiles::begin_next_file() {
  const std::filesystem::path first(path_);
  current_ = path_;
  // Whether the first may be replaced is known; what else is there stays.
  while (++files_ > 1) {
    current_ = (first.parent_path() /
                fmt::format("{}_{}{}", first.stem().string(), files_, first.extension().string()))
                   .string();
    if (!std::filesystem::exists(current_)) break;
  }
  file_ = create_text(current_);
}

void TumFiles::take(std::string_view datagram, const nlohmann::json& /*message*/,
                    std::int64_t /*received_ns*/) {
  PoseMessage message;
  if (parse_message(datagram, message) != MessageKind::pose) return;
  if (!session_.empty() && message.session != session_) begin_next_file();
  session_ = message.session;
  file_ << tum_line(message.pose) << '\n';
  finish_text(file_, current_);
}

void TumFiles::finish() { finish_text(file_, current_); }

}  // namespace lilo
