// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace lilo {

/// Datagrams as they are, one a line: what `lilo eval` and `jq` read.
class JsonLinesFile {
 public:
  /// All throw std::runtime_error.
  explicit JsonLinesFile(const std::string& path);
  void take(std::string_view datagram, const nlohmann::json& message, std::int64_t received_ns);
  void finish();

 private:
  std::string path_;
  std::ofstream file_;
};

}  // namespace lilo
