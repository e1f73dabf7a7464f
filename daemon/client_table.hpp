#pragma once

#include <boost/asio/ip/udp.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilo {

/// Who subscribed, and until when. Never more than `capacity`.
class ClientTable {
 public:
  struct Client {
    boost::asio::ip::udp::endpoint endpoint;
    std::int64_t lease_end_ns = 0;
  };

  explicit ClientTable(std::size_t capacity) : capacity_(capacity) { clients_.reserve(capacity); }

  /// False when the table is full of others.
  bool renew(const boost::asio::ip::udp::endpoint& endpoint, std::int64_t lease_end_ns);
  void remove(const boost::asio::ip::udp::endpoint& endpoint);
  void expire(std::int64_t now_ns);
  [[nodiscard]] bool contains(const boost::asio::ip::udp::endpoint& endpoint) const;
  [[nodiscard]] const std::vector<Client>& clients() const { return clients_; }

 private:
  std::size_t capacity_;
  std::vector<Client> clients_;
};

}  // namespace lilo
