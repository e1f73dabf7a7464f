// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/view/stream_log.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace lilo::view {

/// Where all that is seen comes together, and from where the browsers take it. One thread.
class Hub {
 public:
  explicit Hub(std::size_t most_bytes) : log_(most_bytes) {}

  /// A datagram of the protocol; what is none is left out and counted.
  void take(std::string_view datagram);
  /// Tells the browsers how the view itself is: PROTOCOL.md knows nothing of it.
  void tell(const nlohmann::json& view);

  [[nodiscard]] const StreamLog& log() const { return log_; }
  [[nodiscard]] std::size_t members() const { return members_.size(); }
  [[nodiscard]] std::uint64_t malformed() const { return malformed_; }

  /// `changed` is called whenever there is something new, until leave().
  std::uint64_t join(std::function<void()> changed);
  void leave(std::uint64_t member) { members_.erase(member); }

 private:
  void add(LineKind kind, std::string_view line);

  StreamLog log_;
  std::map<std::uint64_t, std::function<void()>> members_;
  std::uint64_t last_member_ = 0, malformed_ = 0;
};

}  // namespace lilo::view
