#include "drivers/scan_builder.hpp"

#include "drivers/packet_sequence.hpp"
#include "drivers/position_packet.hpp"
#include "drivers/scan_assembler.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/vlp16_decoder.hpp"

#include <algorithm>

namespace lilo {

struct ScanBuilder::Impl {
  Impl(const SensorConfig& config, Scan& target, ScanSink& sink)
      : model(config.model), vlp16(config), assembler(config, target, sink) {}

  void feed(const PacketView& packet);
  void feed_data(const PacketView& packet);
  void feed_position(const PacketView& packet);
  void use(const PacketDecoder& decoder, std::int64_t received_ns, std::uint32_t stamp_us);
  PacketDecoder* decoder_of(DataPacket packet);

  SensorModel model;
  Vlp16Decoder vlp16;
  SensorClock clock;
  PacketSequence sequence;
  ScanAssembler assembler;
  DriverCounts counts;
};

ScanBuilder::ScanBuilder(const SensorConfig& config, Scan& target, ScanSink& sink)
    : impl_(std::make_unique<Impl>(config, target, sink)) {}
ScanBuilder::~ScanBuilder() = default;

void ScanBuilder::feed(const PacketView& packet) { impl_->feed(packet); }
const DriverCounts& ScanBuilder::counts() const { return impl_->counts; }

void ScanBuilder::Impl::feed(const PacketView& packet) {
  if (packet.payload.size() == wire::kDataPacketBytes) {
    feed_data(packet);
  } else if (packet.payload.size() == wire::kPositionPacketBytes) {
    feed_position(packet);
  } else {
    ++counts.malformed_packets;
  }
  counts.scans_complete = assembler.scans_complete();
  counts.scans_partial = assembler.scans_partial();
}

void ScanBuilder::Impl::feed_position(const PacketView& packet) {
  const auto position = parse_position_packet(packet.payload);
  if (!position) {
    ++counts.malformed_packets;
    return;
  }
  ++counts.position_packets;
  if (position->synchronized())
    clock.gps_fix(position->stamp_us, position->gps->utc_ns, packet.received_ns);
}

PacketDecoder* ScanBuilder::Impl::decoder_of(DataPacket packet) {
  // HDL-64E packets name no model; their second block is always of the lower lasers.
  const bool hdl64e = wire::block_flag(packet.data(), 1) == wire::kLowerFlag;
  if (hdl64e || model == SensorModel::hdl64e) return nullptr;
  const std::uint8_t product = wire::u8(packet.data() + wire::kTailOffset + 1);
  const bool known =
      product == Vlp16Decoder::kProductVlp16 || product == Vlp16Decoder::kProductHiRes;
  return known || model == SensorModel::vlp16 ? &vlp16 : nullptr;
}

void ScanBuilder::Impl::feed_data(const PacketView& packet) {
  const DataPacket data = packet.payload.first<wire::kDataPacketBytes>();
  const std::uint32_t stamp_us = wire::u32(data.data() + wire::kStampOffset);
  PacketDecoder* decoder = decoder_of(data);
  if (decoder == nullptr || stamp_us > wire::kMaxStampUs || !decoder->load(data)) {
    ++counts.malformed_packets;
    return;
  }
  ++counts.data_packets;
  use(*decoder, packet.received_ns, stamp_us);
}

void ScanBuilder::Impl::use(const PacketDecoder& decoder, std::int64_t received_ns,
                            std::uint32_t stamp_us) {
  using Arrival = PacketSequence::Arrival;
  const std::int64_t line_ns = clock.unwrap(stamp_us, received_ns);
  const auto verdict = sequence.see(line_ns, received_ns, decoder.packet_period_ns());
  switch (verdict.arrival) {
    case Arrival::duplicate:
      ++counts.packets_duplicated;
      assembler.note_duplicate();
      return;
    case Arrival::late:
      ++counts.packets_reordered;
      counts.packets_lost -= std::min<std::uint64_t>(counts.packets_lost, 1);
      assembler.add_late(decoder, line_ns);
      return;
    case Arrival::restart:
      ++counts.sensor_restarts;
      break;
    case Arrival::first:
    case Arrival::next:
      counts.packets_lost += verdict.lost;
      break;
  }
  assembler.add(decoder, line_ns, verdict, clock);
}

}  // namespace lilo
