// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "daemon/json_writer.hpp"
#include "daemon/saver.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lilo {

/// Most points a scan of each kind that a subscriber will get.
struct PointsGranted {
  int scan = 0, map = 0;
};

/// What became of a subscriber's wish for packets.
enum class PacketsAnswer : std::uint8_t {
  not_asked,
  granted,
  off,    ///< by configuration nobody gets any
  taken,  ///< by as many others as may have them
};

/// Writes the answers of PROTOCOL.md. Each lives until the next one is written. One thread.
class AnswerWriter {
 public:
  /// `session`: the one now running.
  AnswerWriter(const PublishConfig& publish, std::function<const std::string&()> session);

  /// `ttl_s`: the lease granted, 0: none.
  std::string_view hello(double ttl_s, std::optional<PointsGranted> points = {},
                         PacketsAnswer packets = PacketsAnswer::not_asked);
  /// To an address that has not shown one.
  std::string_view token(std::string_view token);
  std::string_view error(std::string_view why);
  /// `done`, or why it is not.
  std::string_view saved(const SaveResult& result);
  std::string_view reset_done();

 private:
  void begin(std::string_view kind);
  std::string_view finish();

  std::string frame_id_, child_frame_id_;
  std::function<const std::string&()> session_;
  JsonWriter out_;
};

}  // namespace lilo
