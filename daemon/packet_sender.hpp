// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/engine.hpp"
#include "daemon/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <functional>

namespace lilo {

/// The sensor's packets to the subscribers that asked for them: every 5 ms what has come, at most
/// 96 packets. Poses that wait go first, before every single packet. The receiver is never woken
/// for it, and does nothing while nobody asks. The publisher's thread.
class PacketSender {
 public:
  /// `send_poses`: sends the poses that wait, if any.
  PacketSender(boost::asio::io_context& io, Engine& engine, Server& server,
               std::function<void()> send_poses);

  /// A client has asked. Ends by itself when the last one has gone.
  void start();

 private:
  void await_look();
  void look();

  Engine& engine_;
  Server& server_;
  std::function<void()> send_poses_;
  boost::asio::steady_timer timer_;
  bool running_ = false;
};

}  // namespace lilo
