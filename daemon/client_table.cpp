#include "daemon/client_table.hpp"

#include <algorithm>

namespace lilo {

const ClientTable::Client* ClientTable::renew(const boost::asio::ip::udp::endpoint& endpoint,
                                              std::int64_t lease_end_ns, bool wants_points) {
  auto client = std::find_if(clients_.begin(), clients_.end(),
                             [&](const Client& c) { return c.endpoint == endpoint; });
  if (client == clients_.end()) {
    if (clients_.size() >= capacity_) return nullptr;
    client = clients_.insert(client, {.endpoint = endpoint});
  }
  client->lease_end_ns = lease_end_ns;
  client->has_points = wants_points && (client->has_points || points_clients() < points_capacity_);
  return &*client;
}

std::size_t ClientTable::points_clients() const {
  return static_cast<std::size_t>(std::count_if(clients_.begin(), clients_.end(),
                                                [](const Client& c) { return c.has_points; }));
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
