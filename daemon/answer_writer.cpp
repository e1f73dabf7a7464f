// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/answer_writer.hpp"

#include "daemon/clock.hpp"
#include "daemon/message_head.hpp"

#include <utility>

namespace lilo {
namespace {

constexpr const char* kSoftware = "lilod " LILO_VERSION;

const char* to_string(PacketsAnswer answer) {
  switch (answer) {
    case PacketsAnswer::granted:
      return "granted";
    case PacketsAnswer::taken:
      return "taken";
    case PacketsAnswer::not_asked:
    case PacketsAnswer::off:
      break;
  }
  return "off";
}

}  // namespace

AnswerWriter::AnswerWriter(const PublishConfig& publish,
                           std::function<const std::string&()> session)
    : frame_id_(publish.frame_id),
      child_frame_id_(publish.child_frame_id),
      session_(std::move(session)) {}

void AnswerWriter::begin(std::string_view kind) {
  begin_message(out_, realtime_ns(), session_());
  out_.begin_object(kind);
}

std::string_view AnswerWriter::finish() {
  out_.end_object();
  return out_.finish();
}

std::string_view AnswerWriter::hello(double ttl_s, std::optional<PointsGranted> points,
                                     PacketsAnswer packets) {
  begin("hello");
  out_.text("software", kSoftware);
  out_.number("ttl_s", ttl_s, 3);
  out_.text("frame_id", frame_id_);
  out_.text("child_frame_id", child_frame_id_);
  if (points) {
    out_.begin_object("points");
    out_.integer("scan", points->scan);
    out_.integer("map", points->map);
    out_.end_object();
  }
  if (packets != PacketsAnswer::not_asked) out_.text("packets", to_string(packets));
  return finish();
}

std::string_view AnswerWriter::token(std::string_view token) {
  begin("hello");
  out_.text("software", kSoftware);
  out_.number("ttl_s", 0.0, 3);
  out_.text("token", token);
  return finish();
}

std::string_view AnswerWriter::error(std::string_view why) {
  begin("error");
  out_.text("reason", why);
  return finish();
}

std::string_view AnswerWriter::saved(const SaveResult& result) {
  if (!result.error.empty()) return error(result.error);
  begin("done");
  out_.text("request", "save");
  out_.text("file", result.file);
  out_.unsigned_integer("count", result.count);
  return finish();
}

std::string_view AnswerWriter::reset_done() {
  begin("done");
  out_.text("request", "reset");
  return finish();
}

}  // namespace lilo
