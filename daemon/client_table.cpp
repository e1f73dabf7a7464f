#include "daemon/client_table.hpp"

#include <algorithm>

namespace lilo {

bool ClientTable::renew(const boost::asio::ip::udp::endpoint& endpoint, std::int64_t lease_end_ns) {
  for (Client& client : clients_) {
    if (client.endpoint != endpoint) continue;
    client.lease_end_ns = lease_end_ns;
    return true;
  }
  if (clients_.size() >= capacity_) return false;
  clients_.push_back({endpoint, lease_end_ns});
  return true;
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
