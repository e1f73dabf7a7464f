// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace lilo {

/// Poses as TUM, `t x y z qx qy qz qw`. A new session has a new origin and so a file of its own:
/// poses.tum, poses_2.tum and so on.
class TumFiles {
 public:
  /// All throw std::runtime_error.
  explicit TumFiles(std::string path);
  void take(std::string_view datagram, const nlohmann::json& message, std::int64_t received_ns);
  void finish();

 private:
  void begin_next_file();

  std::string path_, current_;
  std::string session_;
  int files_ = 0;
  std::ofstream file_;
};

}  // namespace lilo
