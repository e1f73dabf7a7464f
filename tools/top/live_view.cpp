// SPDX-License-Identifier: BSD-3-Clause
#include "tools/top/live_view.hpp"

#include "tools/status/status_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace lilo {
namespace {

using nlohmann::json;

constexpr std::size_t kLatencies = 300, kEvents = 200;
constexpr double kSilentAfterS = 3.0;  // health comes once a second
constexpr std::size_t kLabelColumns = 18;

std::string time_of_day(std::int64_t utc_ns) { return time_words(utc_ns).substr(11, 8); }

/// What keeps health from being good, but for the status, which is told for itself.
json complaints_of(const json& health) {
  json out = json::array();
  for (const json& complaint : health.value("complaints", json::array())) {
    if (complaint != "lost" && complaint != "degraded") out.push_back(complaint);
  }
  return out;
}

/// Rows are ASCII but for the bars, which are made to measure. Of a row that is cut the last column
/// says so, as less(1) does.
StatusRow fitted(StatusRow row, std::size_t columns) {
  const std::size_t room = columns - std::min(columns, kLabelColumns);
  if (row.text.size() <= room) return row;
  row.text.resize(room);
  if (room > 0) row.text.back() = '>';
  return row;
}

/// What nobody has confirmed for seconds is not so now.
StatusRow outdated(StatusRow row) {
  if (row.label == "Status") return {row.label, "unknown, was " + row.text, Colour::bad};
  row.colour = Colour::faint;
  return row;
}

}  // namespace

std::string bars(const std::deque<double>& values, std::size_t columns) {
  constexpr std::array<const char*, 8> kBars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const std::size_t shown = std::min(values.size(), columns);
  const auto first = values.end() - static_cast<std::ptrdiff_t>(shown);
  const double largest = shown == 0 ? 0.0 : *std::max_element(first, values.end());
  std::string text;
  for (auto value = first; value != values.end(); ++value) {
    const double part = largest > 0.0 ? std::clamp(*value / largest, 0.0, 1.0) : 0.0;
    text += kBars[std::min<std::size_t>(static_cast<std::size_t>(part * 8.0), 7)];
  }
  return text;
}

LiveView::LiveView(std::string address, std::string software)
    : report_{.address = std::move(address), .software = std::move(software)} {}

void LiveView::take(const json& message, std::int64_t now_ns) {
  if (silence_noted_) note(now_ns, Colour::good, "lilod answers again");
  silence_noted_ = false;
  silent_s_ = 0.0;
  if (message.contains("health")) take_health(message, now_ns);
  if (message.contains("pose")) take_pose(message, now_ns);
}

void LiveView::silence(double seconds, std::int64_t now_ns) {
  if (seconds < kSilentAfterS) return;
  silent_s_ = seconds;
  if (!silence_noted_) note(now_ns, Colour::bad, "no word from lilod");
  silence_noted_ = true;
}

void LiveView::take_health(const json& message, std::int64_t now_ns) {
  report_.health = message;
  const json now = complaints_of(message.at("health"));
  const auto has = [](const json& list, const json& item) {
    return std::find(list.begin(), list.end(), item) != list.end();
  };
  for (const json& complaint : now) {
    if (!has(complaints_, complaint)) note(now_ns, Colour::bad, complaint.get<std::string>());
  }
  for (const json& complaint : complaints_) {
    if (!has(now, complaint))
      note(now_ns, Colour::good, "no longer: " + complaint.get<std::string>());
  }
  complaints_ = now;
  note_session(message.value("session", ""), now_ns);
  note_status(message.at("health").value("status", ""), now_ns);
}

void LiveView::take_pose(const json& message, std::int64_t now_ns) {
  report_.pose = message;
  const json& pose = message.at("pose");
  latencies_ms_.push_back(pose.value("latency_ms", 0.0));
  if (latencies_ms_.size() > kLatencies) latencies_ms_.pop_front();
  note_session(message.value("session", ""), now_ns);
  note_status(pose.value("status", ""), now_ns);
}

void LiveView::note_session(const std::string& session, std::int64_t now_ns) {
  if (session == session_) return;
  note(now_ns, Colour::warning, "session " + session + (session_.empty() ? "" : ": a new origin"));
  session_ = session;
}

void LiveView::note_status(const std::string& status, std::int64_t now_ns) {
  if (status == status_) return;
  note(now_ns, colour_of_status(status), status);
  status_ = status;
}

void LiveView::note(std::int64_t now_ns, Colour colour, const std::string& what) {
  events_.push_front({time_of_day(now_ns), what, colour});
  if (events_.size() > kEvents) events_.pop_back();
}

std::string LiveView::text(std::size_t rows, std::size_t columns, const Paint& paint) const {
  std::vector<StatusRow> lines;
  if (silent_s_ > 0.0) {
    lines.push_back(
        {"lilod", fmt::format("NO WORD for {} from {}", duration_words(silent_s_), report_.address),
         Colour::bad});
  }
  if (!report_.health.is_null()) {
    for (StatusRow& row : status_rows(report_)) {
      lines.push_back(silent_s_ > 0.0 ? outdated(std::move(row)) : std::move(row));
    }
  } else {
    lines.push_back({"Daemon", fmt::format("{} at {}", report_.software, report_.address)});
  }
  for (StatusRow& row : lines) row = fitted(std::move(row), columns);
  const std::size_t width = columns - std::min(columns, kLabelColumns);
  lines.push_back({"Last latencies", bars(latencies_ms_, width)});
  lines.push_back({"Events (UTC)", "", Colour::none});
  for (const StatusRow& event : events_) lines.push_back(fitted(event, columns));
  lines.resize(std::min(lines.size(), rows - std::min<std::size_t>(rows, 1)));
  std::string out;
  for (const StatusRow& row : lines) out += to_text(row, paint);
  constexpr std::string_view kKeys = "q, Ctrl-C       : ends";
  return out + paint(Colour::faint, kKeys.substr(0, columns)) + "\n";
}

}  // namespace lilo
