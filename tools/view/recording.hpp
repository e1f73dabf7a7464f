// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

namespace lilo::view {

/// How far a recording is read.
struct RecordingState {
  double progress = 0.0;  ///< in [0, 1]
  bool done = false;
  std::string error;  ///< why it ended early; empty: it did not
};

/// Turns a recording into datagrams of the protocol, on a thread of its own: captures and KITTI
/// folders by the odometry, as fast as it goes; recorded datagrams (.jsonl, .mcap) as they are.
class Recording {
 public:
  using Take = std::function<void(std::string_view datagram)>;
  using Tell = std::function<void(const RecordingState&)>;

  /// `take` and `tell` are called on the thread. Throws when the recording cannot be opened.
  Recording(const std::string& path, const Config& config, const Take& take, Tell tell);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lilo::view
