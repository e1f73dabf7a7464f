#pragma once

#include <boost/asio/ip/udp.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilo {

/// Who subscribed, until when, and whether to points. Never more than `capacity`, and of these
/// `points_capacity` with points.
class ClientTable {
 public:
  struct Client {
    boost::asio::ip::udp::endpoint endpoint;
    std::int64_t lease_end_ns = 0;
    bool has_points = false;
  };

  explicit ClientTable(std::size_t capacity, std::size_t points_capacity = 0)
      : capacity_(capacity), points_capacity_(points_capacity) {
    clients_.reserve(capacity);
  }

  /// What is now held of it, until the next change; nullptr when the table is full of others.
  const Client* renew(const boost::asio::ip::udp::endpoint& endpoint, std::int64_t lease_end_ns,
                      bool wants_points = false);
  void remove(const boost::asio::ip::udp::endpoint& endpoint);
  void expire(std::int64_t now_ns);
  [[nodiscard]] bool contains(const boost::asio::ip::udp::endpoint& endpoint) const;
  [[nodiscard]] const std::vector<Client>& clients() const { return clients_; }
  [[nodiscard]] std::size_t points_clients() const;

 private:
  std::size_t capacity_, points_capacity_;
  std::vector<Client> clients_;
};

}  // namespace lilo
