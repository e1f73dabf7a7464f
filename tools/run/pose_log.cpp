// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/pose_log.hpp"

#include "tools/text_file.hpp"

#include <utility>

namespace lilo {

PoseLog::PoseLog(std::string path, const PublishConfig& publish)
    : path_(std::move(path)), file_(create_text(path_)), writer_(publish) {}

void PoseLog::add(const Scan& scan, const Estimate& estimate) {
  const std::string_view line = writer_.pose(scan, estimate);
  if (!line.empty()) file_ << line << '\n';
}

void PoseLog::finish() { finish_text(file_, path_); }

}  // namespace lilo
