// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/extras.hpp"

#include <boost/asio/ip/udp.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilo {

/// Who subscribed, until when, and to what. Never more than `most.clients`, and of these
/// `most.points` with points and `most.packets` with packets.
class ClientTable {
 public:
  struct Capacity {
    std::size_t clients = 0, points = 0, packets = 0;
  };
  struct Client {
    boost::asio::ip::udp::endpoint endpoint;
    std::int64_t lease_end_ns = 0;
    Extras has;
  };

  explicit ClientTable(const Capacity& most) : most_(most) { clients_.reserve(most.clients); }

  /// What is now held of it, until the next change; nullptr when the table is full of others.
  const Client* renew(const boost::asio::ip::udp::endpoint& endpoint, std::int64_t lease_end_ns,
                      Extras wants = {});
  void remove(const boost::asio::ip::udp::endpoint& endpoint);
  void expire(std::int64_t now_ns);
  [[nodiscard]] bool contains(const boost::asio::ip::udp::endpoint& endpoint) const;
  [[nodiscard]] const std::vector<Client>& clients() const { return clients_; }
  [[nodiscard]] std::size_t points_clients() const;
  [[nodiscard]] std::size_t packets_clients() const;

 private:
  Capacity most_;
  std::vector<Client> clients_;
};

}  // namespace lilo
