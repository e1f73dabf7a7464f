// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/log.hpp"

#include "daemon/clock.hpp"
#include "daemon/journal_socket.hpp"
#include "daemon/line_budget.hpp"

#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lilo {
namespace {

constexpr int kEventLines = 6;
constexpr std::int64_t kEventIntervalNs = 60'000'000'000;

/// The level as sd-daemon(3) numbers it.
char priority_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::trace:
    case spdlog::level::debug:
      return '7';
    case spdlog::level::warn:
      return '4';
    case spdlog::level::err:
      return '3';
    case spdlog::level::critical:
      return '2';
    default:
      return '6';
  }
}

class JournalPriority : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    out.push_back('<');
    out.push_back(priority_of(message.level));
    out.push_back('>');
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JournalPriority>();
  }
};

/// journald or stderr, so long as there is budget: whatever repeats itself cannot fill the journal.
class LogSink : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  explicit LogSink(std::string instance)
      : instance_(std::move(instance)), journal_(journal_socket_path()) {}

  void set_context(std::string_view session, std::string_view status) {
    session_ = session;
    status_ = status;
  }
  bool take_budget_of(Event event) {
    return event_budgets_[static_cast<std::size_t>(event)].take(monotonic_ns());
  }
  /// Of the messages from now on; empty: none.
  void set_message_id(std::string_view id) { message_id_ = id; }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (!budget_.take(monotonic_ns())) return;
    if (const std::uint64_t lines = budget_.take_left_out() + std::exchange(unread_, 0);
        lines > 0) {
      const std::string text = fmt::format("{} lines were left out here", lines);
      write(spdlog::details::log_msg(message.logger_name, spdlog::level::warn, text));
    }
    write(message);
  }
  void flush_() override { std::fflush(stderr); }

 private:
  void write(const spdlog::details::log_msg& message) {
    const char priority = priority_of(message.level);
    const JournalSocket::Sent sent =
        journal_.send({{"MESSAGE", {message.payload.data(), message.payload.size()}},
                       {"PRIORITY", {&priority, 1}},
                       {"SYSLOG_IDENTIFIER", "lilod"},
                       {"MESSAGE_ID", message_id_},
                       {"INSTANCE", instance_},
                       {"SESSION", session_},
                       {"STATUS", status_}});
    if (sent == JournalSocket::Sent::full) ++unread_;
    if (sent != JournalSocket::Sent::no) return;
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    std::fwrite(text.data(), 1, text.size(), stderr);
  }

  std::string instance_, session_, status_;
  std::string_view message_id_;
  JournalSocket journal_;
  LineBudget budget_{50, 10'000'000'000};
  std::vector<LineBudget> event_budgets_ =
      std::vector<LineBudget>(kEventCount, LineBudget(kEventLines, kEventIntervalNs));
  std::uint64_t unread_ = 0;  // lines that journald had no room for
};

// The one that start_log() set up; nothing in a program that has another.
LogSink* sink() {
  const auto& sinks = spdlog::default_logger_raw()->sinks();
  return sinks.empty() ? nullptr : dynamic_cast<LogSink*>(sinks.front().get());
}

spdlog::level::level_enum level_of(Severity severity) {
  switch (severity) {
    case Severity::error:
      return spdlog::level::err;
    case Severity::warning:
      return spdlog::level::warn;
    case Severity::info:
      return spdlog::level::info;
  }
  return spdlog::level::info;
}

}  // namespace

void set_log_level(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::set_level(spdlog::level::debug);
    case LogLevel::info:
      return spdlog::set_level(spdlog::level::info);
    case LogLevel::warning:
      return spdlog::set_level(spdlog::level::warn);
    case LogLevel::error:
      return spdlog::set_level(spdlog::level::err);
  }
}

void start_log(LogLevel level, const std::string& instance) {
  auto logger = std::make_shared<spdlog::logger>("lilod", std::make_shared<LogSink>(instance));
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;  // NOLINT(concurrency-mt-unsafe)
  if (journal) {
    formatter->add_flag<JournalPriority>('*').set_pattern("%*%v");
  } else {
    formatter->set_pattern("%H:%M:%S.%e lilod %l: %v");
  }
  logger->set_formatter(std::move(formatter));
  logger->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(std::move(logger));
  set_log_level(level);
}

void set_log_context(std::string_view session, std::string_view status) {
  if (LogSink* const log = sink()) log->set_context(session, status);
}

bool log_event(Event event, std::string_view text) {
  LogSink* const log = sink();
  if (log != nullptr && !log->take_budget_of(event)) return false;
  const EventDescription description = describe(event);
  if (log != nullptr) log->set_message_id(description.message_id);
  spdlog::log(level_of(description.severity), "{}", text);
  if (log != nullptr) log->set_message_id({});
  return true;
}

}  // namespace lilo
