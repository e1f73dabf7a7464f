// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace lilo::view {

/// What a line of the stream is about.
enum class LineKind : std::uint8_t { pose, points, health, other };

/// All that happened, a datagram a line, for browsers that come later and for those that read
/// slowly: each reads on from where it was. Memory is bounded: when it is full, every second
/// datagram of points goes, then every second of the others, oldest half first; the protocol makes
/// their loss harmless. One thread.
class StreamLog {
 public:
  explicit StreamLog(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  struct Line {
    std::uint64_t id;  ///< counts from 1
    LineKind kind;
    std::string text;
  };

  void add(LineKind kind, std::string_view text);
  /// Lines after `id`, each with a line end behind it, about `most_bytes`; and the last one's id.
  std::uint64_t read_after(std::uint64_t id, std::size_t most_bytes, std::string& out) const;
  /// Calls `visit(line)` for every line after `id`.
  template <typename Visit>
  void for_each_after(std::uint64_t id, const Visit& visit) const {
    for (auto line = first_after(id); line != lines_.end(); ++line) visit(*line);
  }

  [[nodiscard]] std::uint64_t last_id() const { return last_id_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  /// How many times lines were left out to make room.
  [[nodiscard]] int thinnings() const { return thinnings_; }

 private:
  using Lines = std::deque<Line>;
  [[nodiscard]] Lines::const_iterator first_after(std::uint64_t id) const;
  /// Every second one of the older half whose kind is (or is not) points.
  void thin(bool points);

  std::size_t most_bytes_, bytes_ = 0;
  std::uint64_t last_id_ = 0;
  int thinnings_ = 0;
  Lines lines_;
};

}  // namespace lilo::view
