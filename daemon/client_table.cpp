// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client_table.hpp"

#include <algorithm>

namespace lilo {

const ClientTable::Client* ClientTable::renew(const boost::asio::ip::udp::endpoint& endpoint,
                                              std::int64_t lease_end_ns, Extras wants) {
  auto client = std::find_if(clients_.begin(), clients_.end(),
                             [&](const Client& c) { return c.endpoint == endpoint; });
  if (client == clients_.end()) {
    if (clients_.size() >= most_.clients) return nullptr;
    client = clients_.insert(client, {.endpoint = endpoint});
  }
  client->lease_end_ns = lease_end_ns;
  Extras& has = client->has;
  has.points = wants.points && (has.points || points_clients() < most_.points);
  has.packets = wants.packets && (has.packets || packets_clients() < most_.packets);
  return &*client;
}

std::size_t ClientTable::points_clients() const {
  return static_cast<std::size_t>(std::count_if(clients_.begin(), clients_.end(),
                                                [](const Client& c) { return c.has.points; }));
}

std::size_t ClientTable::packets_clients() const {
  return static_cast<std::size_t>(std::count_if(clients_.begin(), clients_.end(),
                                                [](const Client& c) { return c.has.packets; }));
}

void ClientTable::remove(const boost::asio::ip::udp::endpoint& endpoint) {
  std::erase_if(clients_, [&](const Client& client) { return client.endpoint == endpoint; });
}

void ClientTable::expire(std::int64_t now_ns) {
  std::erase_if(clients_, [&](const Client& client) { return client.lease_end_ns <= now_ns; });
}

bool ClientTable::contains(const boost::asio::ip::udp::endpoint& endpoint) const {
  return std::any_of(clients_.begin(), clients_.end(),
                     [&](const Client& client) { return client.endpoint == endpoint; });
}

}  // namespace lilo
