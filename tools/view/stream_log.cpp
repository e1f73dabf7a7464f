// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/stream_log.hpp"

#include <algorithm>
#include <utility>

namespace lilo::view {
namespace {

constexpr std::size_t kOverhead = sizeof(StreamLog::Line) + 32;  // of a line, and its allocation's

std::size_t cost(const StreamLog::Line& line) { return line.text.size() + kOverhead; }

}  // namespace

void StreamLog::add(LineKind kind, std::string_view text) {
  lines_.push_back({++last_id_, kind, std::string(text)});
  bytes_ += cost(lines_.back());
  if (bytes_ <= most_bytes_) return;
  ++thinnings_;
  thin(true);
  if (bytes_ > most_bytes_ / 8 * 7) thin(false);
}

void StreamLog::thin(bool points) {
  Lines kept;
  std::size_t seen = 0, bytes = 0;
  const std::size_t older = lines_.size() / 2;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    Line& line = lines_[k];
    const bool meant = k < older && (line.kind == LineKind::points) == points;
    if (meant && seen++ % 2 == 1) continue;
    bytes += cost(line);
    kept.push_back(std::move(line));
  }
  lines_ = std::move(kept);
  bytes_ = bytes;
}

StreamLog::Lines::const_iterator StreamLog::first_after(std::uint64_t id) const {
  return std::upper_bound(lines_.begin(), lines_.end(), id,
                          [](std::uint64_t wanted, const Line& line) { return wanted < line.id; });
}

std::uint64_t StreamLog::read_after(std::uint64_t id, std::size_t most_bytes,
                                    std::string& out) const {
  out.clear();
  for (auto line = first_after(id); line != lines_.end() && out.size() < most_bytes; ++line) {
    out += line->text;
    out += '\n';
    id = line->id;
  }
  return id;
}

}  // namespace lilo::view
