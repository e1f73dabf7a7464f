// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/receiver.hpp"
#include "daemon/saver.hpp"

#include <boost/asio/io_context.hpp>

#include <cstdint>
#include <string>

namespace lilo {

/// Keeps the table that an HDL-64E's packets brought, for the next start: on the saver's thread, so
/// that no disk holds the receiver up. One thread calls.
class CalibrationKeeper {
 public:
  /// `directory`: where; empty: nowhere.
  CalibrationKeeper(boost::asio::io_context& io, const Receiver& receiver, std::string directory);

  /// Once a second: stores a table that is new. What cannot be is logged, and tried again with the
  /// next table alone.
  void look();

 private:
  const Receiver& receiver_;
  std::string directory_;
  std::uint64_t kept_ = 0;  // of Receiver::calibrations_read()
  Saver saver_;
};

}  // namespace lilo
