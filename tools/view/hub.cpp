// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/hub.hpp"

#include <utility>

namespace lilo::view {
namespace {

using nlohmann::json;

LineKind kind_of(const json& message) {
  if (message.contains("pose")) return LineKind::pose;
  if (message.contains("points")) return LineKind::points;
  if (message.contains("health")) return LineKind::health;
  return LineKind::other;
}

}  // namespace

void Hub::take(std::string_view datagram) {
  const json message = json::parse(datagram, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) {
    ++malformed_;
    return;
  }
  const LineKind kind = kind_of(message);
  // Answers to the view's own requests come every second, and say nothing but that.
  if (message.contains("hello")) return;
  if (datagram.find('\n') == std::string_view::npos) {
    add(kind, datagram);
  } else {
    add(kind, message.dump());
  }
}

void Hub::tell(const json& view) { add(LineKind::other, json{{"view", view}}.dump()); }

void Hub::add(LineKind kind, std::string_view line) {
  log_.add(kind, line);
  for (const auto& [member, changed] : members_) changed();
}

std::uint64_t Hub::join(std::function<void()> changed) {
  members_.emplace(++last_member_, std::move(changed));
  return last_member_;
}

}  // namespace lilo::view
