#include "tools/record/packet_recorder.hpp"

#include <stdexcept>

namespace lilo {

PacketRecorder::PacketRecorder(const LilodAddress& address, const std::string& path)
    : lilod_(address), file_(path, /*nanoseconds=*/true), thread_([this] { run(); }) {}

PacketRecorder::~PacketRecorder() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void PacketRecorder::run() {
  constexpr std::chrono::milliseconds kLook{100};
  try {
    lilod_.subscribe(Subscription::packets);
    while (!stop_) {
      const auto datagram = lilod_.receive(kLook);
      if (!datagram) continue;
      if (const auto numbered = read_tapped(*datagram)) take(*numbered);
    }
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
}

// Whoever lilod got it from sent it here: to which address, its socket does not say.
void PacketRecorder::take(const NumberedPacket& numbered) {
  if (next_number_) missed_ += numbered.number - *next_number_;
  next_number_ = numbered.number + 1;
  const PacketView& packet = numbered.packet;
  file_.write({.source_ipv4 = packet.source_ipv4,
               .destination_ipv4 = 0xFFFFFFFF,
               .source_port = packet.source_port,
               .destination_port = packet.destination_port},
              packet.payload, packet.received_ns);
  ++packets_;
}

void PacketRecorder::finish() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  file_.close();
  if (!failure_.empty()) throw std::runtime_error(failure_);
}

}  // namespace lilo
