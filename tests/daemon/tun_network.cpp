// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/tun_network.hpp"

#include <linux/if_tun.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <net/if.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace lilo {
namespace {

constexpr std::uint32_t kNetwork = 10U << 24U | 77U << 16U, kComputer = kNetwork | 1U;
constexpr std::size_t kHeaderBytes = sizeof(iphdr) + sizeof(udphdr);

void require(bool holds, const char* what) {
  if (!holds) throw std::system_error(errno, std::generic_category(), what);
}

// Root may leave the network as it is; others need a user namespace in which they are root.
void leave_network() {
  if (unshare(CLONE_NEWNET) == 0) return;
  const std::string user = std::to_string(getuid()), group = std::to_string(getgid());
  require(unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0, "unshare");
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << "0 " + user + " 1";
  std::ofstream("/proc/self/gid_map") << "0 " + group + " 1";
}

sockaddr address(std::uint32_t ipv4) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  in.sin_addr.s_addr = htonl(ipv4);
  sockaddr out{};
  std::memcpy(&out, &in, sizeof(out));
  return out;
}

ifreq interface(const char* name) {
  ifreq out{};
  std::strncpy(out.ifr_name, name, IFNAMSIZ - 1);
  return out;
}

void bring_up(int control, const char* name) {
  ifreq request = interface(name);
  require(ioctl(control, SIOCGIFFLAGS, &request) == 0, name);
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
  require(ioctl(control, SIOCSIFFLAGS, &request) == 0, name);
}

// RFC 1071.
std::uint16_t checksum(const iphdr& header) {
  std::array<std::uint16_t, sizeof(iphdr) / 2> words{};
  std::memcpy(words.data(), &header, sizeof(header));
  std::uint32_t sum = 0;
  for (const std::uint16_t word : words) sum += word;
  while (sum > 0xffff) sum = (sum & 0xffffU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

}  // namespace

TunNetwork::TunNetwork() {
  leave_network();
  fd_ = open("/dev/net/tun", O_RDWR | O_CLOEXEC);
  require(fd_ >= 0, "/dev/net/tun");
  ifreq request = interface("lilo0");
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  require(ioctl(fd_, TUNSETIFF, &request) == 0, "TUNSETIFF");
  const int control = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  request = interface("lilo0");
  request.ifr_addr = address(kComputer);
  require(ioctl(control, SIOCSIFADDR, &request) == 0, "SIOCSIFADDR");
  request.ifr_netmask = address(0xffff0000U);
  require(ioctl(control, SIOCSIFNETMASK, &request) == 0, "SIOCSIFNETMASK");
  request.ifr_qlen = 100'000;  // what nobody has read yet is not lost
  require(ioctl(control, SIOCSIFTXQLEN, &request) == 0, "SIOCSIFTXQLEN");
  bring_up(control, "lo");
  bring_up(control, "lilo0");
  close(control);
}

TunNetwork::~TunNetwork() { close(fd_); }

TunNetwork::Endpoint TunNetwork::host(unsigned third, unsigned fourth, std::uint16_t port) {
  return {kNetwork | third << 8U | fourth, port};
}

void TunNetwork::send(const Endpoint& from, std::uint16_t to_port, std::string_view payload) const {
  const std::size_t size = kHeaderBytes + payload.size();
  iphdr ip{};
  ip.version = 4;
  ip.ihl = 5;
  ip.ttl = 64;
  ip.protocol = IPPROTO_UDP;
  ip.tot_len = htons(static_cast<std::uint16_t>(size));
  ip.saddr = htonl(from.ipv4);
  ip.daddr = htonl(kComputer);
  ip.check = checksum(ip);
  udphdr udp{};  // without a checksum, which IPv4 allows
  udp.source = htons(from.port);
  udp.dest = htons(to_port);
  udp.len = htons(static_cast<std::uint16_t>(sizeof(udp) + payload.size()));
  std::array<char, 1500> packet{};
  std::memcpy(packet.data(), &ip, sizeof(ip));
  std::memcpy(packet.data() + sizeof(ip), &udp, sizeof(udp));
  std::memcpy(packet.data() + kHeaderBytes, payload.data(), payload.size());
  require(write(fd_, packet.data(), size) == static_cast<ssize_t>(size), "write");
}

std::optional<TunNetwork::Datagram> TunNetwork::receive(std::chrono::milliseconds at_most) const {
  pollfd waiting{.fd = fd_, .events = POLLIN};
  while (poll(&waiting, 1, static_cast<int>(at_most.count())) > 0) {
    std::array<char, 2048> packet{};
    const ssize_t size = read(fd_, packet.data(), packet.size());
    iphdr ip{};
    udphdr udp{};
    if (size < static_cast<ssize_t>(kHeaderBytes)) continue;
    std::memcpy(&ip, packet.data(), sizeof(ip));
    std::memcpy(&udp, packet.data() + sizeof(ip), sizeof(udp));
    if (ip.version != 4 || ip.protocol != IPPROTO_UDP) continue;
    return Datagram{
        {ntohl(ip.daddr), ntohs(udp.dest)},
        std::string(packet.data() + kHeaderBytes, static_cast<std::size_t>(size) - kHeaderBytes)};
  }
  return std::nullopt;
}

}  // namespace lilo
