// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_estimate.hpp"
#include "daemon/saver.hpp"
#include "daemon/snapshot.hpp"

#include <boost/asio/io_context.hpp>

#include <cstdint>
#include <string>

namespace lilo {

/// What an earlier run found of the beams and kept in `directory`; nothing (no rings) where there
/// is none. A file that cannot be read is named in the log.
BeamEstimate kept_beams(const std::string& directory);

/// Keeps what is found of the beams for the next start, once a minute on the saver's thread, and at
/// the end. One thread calls.
class BeamKeeper {
 public:
  /// `directory`: where; empty: nowhere.
  BeamKeeper(boost::asio::io_context& io, const Snapshot<BeamEstimate>& beams,
             std::string directory);

  /// Once a second. What cannot be kept is tried again a minute later, and logged where the reason
  /// is another.
  void look();
  /// When the worker has ended.
  void finish();

 private:
  [[nodiscard]] bool is_new();
  void note(const std::string& error);

  const Snapshot<BeamEstimate>& beams_;
  std::string directory_;
  BeamEstimate now_, kept_;
  std::string last_error_;
  int seconds_ = 0;  // since the last look at the beams
  Saver saver_;
};

}  // namespace lilo
