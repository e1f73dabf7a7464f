// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/foxglove_session.hpp"

#include "tools/message_numbers.hpp"

#include <utility>

namespace lilo::view {
namespace {

using nlohmann::json;

// A client that reads too slowly misses what would be beyond it.
constexpr std::size_t kMostWaiting = 1000;

std::int64_t stamp_of(const json& message) {
  if (message.contains("pose")) return stamp_ns_from(message["pose"].at("stamp"));
  return timestamp_ns_from(message.at("timestamp"));
}

}  // namespace

std::string foxglove_protocol(std::string_view offered) {
  for (const char* ours : {"foxglove.sdk.v1", "foxglove.websocket.v1"}) {
    if (offered.find(ours) != std::string_view::npos) return ours;
  }
  return {};
}

FoxgloveSession::FoxgloveSession(const StreamLog& log) : log_(log), position_(log.last_id()) {
  const json info{{"op", "serverInfo"},
                  {"name", "lilo view " LILO_VERSION},
                  {"capabilities", json::array()},
                  {"supportedEncodings", json::array()},
                  {"metadata", json::object()}};
  waiting_.push_back({info.dump(), false});
  waiting_.push_back({foxglove_advertisement(), false});
}

void FoxgloveSession::take(std::string_view text) {
  const json message = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return;
  try {
    const json op = message.value("op", json());
    if (op == "subscribe") {
      for (const json& each : message.at("subscriptions"))
        channel_of_[each.at("id").get<std::uint32_t>()] =
            static_cast<FoxgloveChannel>(each.at("channelId").get<std::uint32_t>());
    } else if (op == "unsubscribe") {
      for (const json& id : message.at("subscriptionIds"))
        channel_of_.erase(id.get<std::uint32_t>());
    }
  } catch (const json::exception&) {  // nothing of ours
  }
  if (channel_of_.size() > kMostWaiting) channel_of_.clear();
}

bool FoxgloveSession::next(std::string& message, bool& is_binary) {
  log_.for_each_after(position_, [&](const StreamLog::Line& line) {
    position_ = line.id;
    if (!channel_of_.empty() && waiting_.size() < kMostWaiting) take_line(line);
  });
  if (waiting_.empty()) return false;
  message = std::move(waiting_.front().text);
  is_binary = waiting_.front().is_binary;
  waiting_.pop_front();
  return true;
}

void FoxgloveSession::take_line(const StreamLog::Line& line) {
  if (line.kind == LineKind::other) return;
  try {
    const json message = json::parse(line.text);
    stamp_ns_ = stamp_of(message);
    if (line.kind == LineKind::pose) take_pose(message);
    if (line.kind == LineKind::points) take_points(message);
    if (line.kind == LineKind::health) send(FoxgloveChannel::health, message.at("health"));
  } catch (const json::exception&) {  // another version's: what is not understood is left out
  }
}

void FoxgloveSession::take_pose(const json& message) {
  const json& pose = message.at("pose");
  send(FoxgloveChannel::transforms, foxglove_transforms(pose));
  send(FoxgloveChannel::pose, foxglove_pose(pose));
  send(FoxgloveChannel::datagram, message);
  last_pose_ = message;
}

void FoxgloveSession::take_points(const json& message) {
  if (last_pose_.is_null() || last_pose_["seq"] != message.at("seq")) return;
  const bool is_scan = message.at("points").at("of") == "scan";
  FoxglovePoints& points = is_scan ? scan_ : map_;
  if (!points.add(message)) return;
  const json& pose = last_pose_["pose"];
  stamp_ns_ = stamp_of(last_pose_);
  send(is_scan ? FoxgloveChannel::scan : FoxgloveChannel::map,
       points.cloud(pose.at("stamp"), pose.at("child_frame_id")));
}

void FoxgloveSession::send(FoxgloveChannel channel, const json& payload) {
  for (const auto& [subscription, wanted] : channel_of_) {
    if (wanted == channel)
      waiting_.push_back({foxglove_message(subscription, stamp_ns_, payload.dump()), true});
  }
}

}  // namespace lilo::view
