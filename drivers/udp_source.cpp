#include "drivers/packet_source.hpp"
#include "drivers/udp_socket.hpp"

#include <boost/asio/ip/address_v4.hpp>

#include <array>
#include <chrono>
#include <optional>
#include <poll.h>
#include <thread>

namespace lilo {
namespace {

// Short enough for the socket's buffer to hold what comes meanwhile.
constexpr std::chrono::milliseconds kAfterAnError{10};

class TwoPortSource final : public UdpSource {
 public:
  explicit TwoPortSource(const UdpConfig& config);
  ReadResult read(PacketView& packet, std::chrono::milliseconds timeout) override;
  [[nodiscard]] SourceCounts counts() const override;
  [[nodiscard]] int receive_buffer_bytes() const override { return data_.receive_buffer_bytes(); }
  [[nodiscard]] std::uint16_t data_port() const override { return data_.port(); }

 private:
  bool take(UdpSocket& socket, PacketView& packet);
  bool fill();
  [[nodiscard]] std::uint64_t receive_errors() const;
  bool wait(std::chrono::milliseconds timeout);

  boost::asio::io_context context_;
  UdpSocket data_;
  std::optional<UdpSocket> position_;
  std::uint32_t sensor_ipv4_ = 0;  // 0: any
  SourceCounts counts_;
};

std::uint32_t sensor_address_of(const std::string& text) {
  if (text.empty()) return 0;
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address_v4(text, error);
  if (error) throw DriverError("sensor address: expected an IPv4 address, found \"" + text + "\"");
  return address.to_uint();
}

TwoPortSource::TwoPortSource(const UdpConfig& config)
    : data_(context_, config, config.data_port),
      sensor_ipv4_(sensor_address_of(config.sensor_address)) {
  if (config.position_port != 0) position_.emplace(context_, config, config.position_port);
}

SourceCounts TwoPortSource::counts() const {
  SourceCounts counts = counts_;
  counts.kernel_dropped = data_.kernel_dropped() + (position_ ? position_->kernel_dropped() : 0);
  counts.receive_errors = receive_errors();
  return counts;
}

std::uint64_t TwoPortSource::receive_errors() const {
  return data_.receive_errors() + (position_ ? position_->receive_errors() : 0);
}

bool TwoPortSource::take(UdpSocket& socket, PacketView& packet) {
  bool truncated = false;
  while (socket.next(packet, truncated)) {
    if (sensor_ipv4_ != 0 && packet.source_ipv4 != sensor_ipv4_) {
      ++counts_.foreign;
    } else if (truncated) {
      ++counts_.truncated;
    } else {
      ++counts_.packets;
      return true;
    }
  }
  return false;
}

bool TwoPortSource::wait(std::chrono::milliseconds timeout) {
  std::array<pollfd, 2> ports{};
  ports[0] = {.fd = data_.native(), .events = POLLIN, .revents = 0};
  if (position_) ports[1] = {.fd = position_->native(), .events = POLLIN, .revents = 0};
  return poll(ports.data(), position_ ? 2 : 1, static_cast<int>(timeout.count())) > 0;
}

ReadResult TwoPortSource::read(PacketView& packet, std::chrono::milliseconds timeout) {
  // Twice at most, so that a flood of other senders' packets cannot keep the caller here.
  for (const bool may_wait : {true, false}) {
    // Position packets first: they are few, and what they say is about the data that follow.
    if (position_ && take(*position_, packet)) return ReadResult::packet;
    if (take(data_, packet)) return ReadResult::packet;
    if (fill() || !may_wait) continue;
    if (!wait(timeout)) return ReadResult::timeout;
    fill();
  }
  if (position_ && take(*position_, packet)) return ReadResult::packet;
  return take(data_, packet) ? ReadResult::packet : ReadResult::timeout;
}

bool TwoPortSource::fill() {
  const std::uint64_t errors_before = receive_errors();
  const bool position_came = position_ && position_->fill();
  if (data_.fill() || position_came) return true;
  // A socket with an error counts as readable: at real-time priority it would take the whole core.
  if (receive_errors() != errors_before) std::this_thread::sleep_for(kAfterAnError);
  return false;
}

}  // namespace

std::unique_ptr<UdpSource> open_udp(const UdpConfig& config) {
  return std::make_unique<TwoPortSource>(config);
}

}  // namespace lilo
