// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/json_lines_file.hpp"

#include "tools/text_file.hpp"

namespace lilo {

JsonLinesFile::JsonLinesFile(const std::string& path) : path_(path), file_(create_text(path)) {}

// Flushed line by line: whoever ends this may be in a hurry.
void JsonLinesFile::take(std::string_view datagram, const nlohmann::json& /*message*/,
                         std::int64_t /*received_ns*/) {
  file_ << datagram << '\n';
  finish_text(file_, path_);
}

void JsonLinesFile::finish() { finish_text(file_, path_); }

}  // namespace lilo
