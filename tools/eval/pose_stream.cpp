// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/pose_stream.hpp"

#include "daemon/message_head.hpp"
#include "daemon/pose_message.hpp"
#include "tools/listen/pose_message.hpp"
#include "tools/record/mcap_reader.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace lilo {
namespace {

std::optional<TrackingStatus> status_named(const std::string& name) {
  for (const TrackingStatus status : {TrackingStatus::initializing, TrackingStatus::tracking,
                                      TrackingStatus::degraded, TrackingStatus::lost}) {
    if (name == to_string(status)) return status;
  }
  return std::nullopt;
}

/// Takes the lines or messages of a file one by one.
class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) { stream.name = path; }

  void take(const std::string& line) {
    ++number_;
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    PoseMessage message;
    const MessageKind kind = parse_message(line, message);
    if (kind == MessageKind::malformed) throw error("expected a datagram of lilod, found none");
    if (kind == MessageKind::other_version) {
      throw error(fmt::format("expected protocol {}, found another version", kProtocolVersion));
    }
    if (kind == MessageKind::pose) add(message);
  }

  PoseStream stream;

 private:
  [[nodiscard]] std::runtime_error error(const std::string& what) const {
    return std::runtime_error(fmt::format("{}:{}: {}", path_, number_, what));
  }

  void add(const PoseMessage& message) {
    const auto status = status_named(message.status);
    if (!status) throw error(fmt::format("expected a status, found '{}'", message.status));
    std::vector<SaidPose>& poses = stream.poses;
    if (!poses.empty()) {
      if (message.pose.stamp_ns <= poses.back().pose.stamp_ns) {
        throw error("expected a later time than in the pose before");
      }
      if (message.session != session_) ++sessions_;
    }
    session_ = message.session;
    poses.push_back({message.pose, *status, sessions_, message.covariance});
  }

  const std::string& path_;
  int number_ = 0;
  std::string session_;
  int sessions_ = 0;  // before the one of session_
};

bool is_mcap(const std::string& path) { return std::filesystem::path(path).extension() == ".mcap"; }

void read_lines(const std::string& path, Reader& reader) {
  std::ifstream file = open_text(path);
  for (std::string line; std::getline(file, line);) reader.take(line);
}

void read_mcap(const std::string& path, Reader& reader) {
  mcap::Reader file(path);
  for (mcap::Message message; file.next(message);) {
    if (message.topic.starts_with("/lilod/")) reader.take(std::string(message.data));
  }
}

}  // namespace

bool is_pose_stream(const std::string& path) {
  if (is_mcap(path)) return true;
  std::ifstream file = open_text(path);
  char first = 0;
  return file >> first && first == '{';
}

PoseStream read_pose_stream(const std::string& path) {
  Reader reader(path);
  is_mcap(path) ? read_mcap(path, reader) : read_lines(path, reader);
  if (reader.stream.poses.empty()) {
    throw std::runtime_error(fmt::format("{}: expected poses of lilod, found none", path));
  }
  return std::move(reader.stream);
}

Trajectory trajectory(const PoseStream& stream) {
  Trajectory poses{.name = stream.name, .has_times = true};
  poses.poses.reserve(stream.poses.size());
  for (const SaidPose& said : stream.poses) poses.poses.push_back(said.pose);
  return poses;
}

}  // namespace lilo
