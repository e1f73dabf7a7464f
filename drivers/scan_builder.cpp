// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/scan_builder.hpp"

#include "drivers/hdl64e_unit.hpp"
#include "drivers/packet_decoder.hpp"
#include "drivers/packet_sequence.hpp"
#include "drivers/position_packet.hpp"
#include "drivers/scan_assembler.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/sensor_identity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace lilo {
namespace {

// A sensor that was silent for so long may be replaced by another one on the same network.
constexpr std::int64_t kReplaceableNs = 2'000'000'000;

enum class Outcome : std::uint8_t {
  used,
  refused,  // of another model
  malformed,
};

}  // namespace

std::optional<Calibration> configured_calibration(const SensorConfig& config) {
  if (config.calibration_file.empty()) return std::nullopt;
  Calibration calibration = load_calibration(config.calibration_file);
  const SensorTable* table = find_sensor(config.model);
  const auto count = static_cast<int>(calibration.lasers.size());
  if (table != nullptr && table->lasers != count)
    throw DriverError(config.calibration_file + ": expected the " + std::to_string(table->lasers) +
                      " lasers of a " + table->name + ", found " + std::to_string(count));
  return calibration;
}

struct ScanBuilder::Impl {
  Impl(const SensorConfig& config, Scan& target, ScanSink& sink)
      : model(config.model),
        ignore_product(config.ignore_product_byte),
        position_port(config.position_port),
        file(configured_calibration(config)),
        decoder(config, azimuths),
        hdl64e(config, file_of(64), decoder),
        assembler(config, target, sink) {
    use_file();  // the decoder begins with the table of a VLP-16, whose packets do not change it
  }

  // The configured calibration, if it is of so many lasers.
  [[nodiscard]] const Calibration* file_of(int lasers) const {
    return file && static_cast<int>(file->lasers.size()) == lasers ? &*file : nullptr;
  }

  void feed(const PacketView& packet);
  bool is_followed(const PacketView& packet);
  Outcome feed_data(const PacketView& packet);
  Outcome feed_position(const PacketView& packet);
  [[nodiscard]] const SensorTable* accept(const SensorIdentity& identity,
                                          std::int64_t received_ns) const;
  void refuse(const SensorIdentity& identity);
  void follow(const SensorTable& table);
  void use_file();
  bool feed_vlp(DataPacket data, std::uint32_t stamp_us, std::int64_t received_ns);
  bool feed_hdl64e(DataPacket data, std::uint32_t stamp_us, std::int64_t received_ns);
  std::optional<std::uint32_t> place(std::uint32_t stamp_us, std::int64_t line_ns,
                                     std::int64_t received_ns);
  void restart_line(std::uint32_t stamp_us, std::int64_t received_ns);
  std::uint32_t add_newest(std::int64_t line_ns, std::uint32_t missing);

  SensorModel model;
  bool ignore_product;
  std::uint16_t position_port;
  SensorModel seen_model = SensorModel::automatic;
  std::optional<Calibration> file;
  AzimuthTable azimuths;
  PacketDecoder decoder;
  Hdl64eUnit hdl64e;
  SensorClock clock;
  PacketSequence sequence;
  ScanAssembler assembler;
  DriverCounts counts;
  RefusedSensor refused;
  std::uint32_t sensor_ipv4 = 0;
  std::int64_t sensor_heard_ns = 0;
  std::int64_t model_heard_ns = 0;
};

ScanBuilder::ScanBuilder(const SensorConfig& config, Scan& target, ScanSink& sink)
    : impl_(std::make_unique<Impl>(config, target, sink)) {}
ScanBuilder::~ScanBuilder() = default;

void ScanBuilder::feed(const PacketView& packet) { impl_->feed(packet); }
const DriverCounts& ScanBuilder::counts() const { return impl_->counts; }
const Calibration* ScanBuilder::calibration() const { return impl_->hdl64e.calibration(); }

void ScanBuilder::use_calibration(const Calibration& calibration) {
  impl_->assembler.interrupt(impl_->clock);
  impl_->hdl64e.use_calibration(calibration, CalibrationOrigin::packets);
}

SensorStatus ScanBuilder::status() const {
  const Impl& impl = *impl_;
  SensorStatus status{.model = impl.seen_model,
                      .configured = impl.model,
                      .clock = impl.clock.source(),
                      .sensor_ipv4 = impl.sensor_ipv4};
  status.refused = impl.refused;
  if (impl.seen_model == SensorModel::automatic) return status;
  const SensorTable& table = impl.decoder.table();
  status.product_id = table.product;
  status.return_mode = impl.decoder.mode();
  status.packet_period_us = impl.decoder.packet_period_ns() * 1e-3;
  status.calibration =
      impl.file_of(table.lasers) != nullptr ? CalibrationOrigin::file : CalibrationOrigin::built_in;
  if (impl.seen_model == SensorModel::hdl64e) impl.hdl64e.describe(status);
  impl.assembler.describe(status);
  status.rpm = std::abs(impl.decoder.ticks_per_ns()) * 60e9 / wire::kTicksPerTurn;
  return status;
}

void ScanBuilder::Impl::feed(const PacketView& packet) {
  if (!is_followed(packet)) {
    ++counts.foreign_packets;
    return;
  }
  const bool on_position_port = position_port != 0 && packet.destination_port == position_port;
  const Outcome outcome = on_position_port ? feed_position(packet) : feed_data(packet);
  if (outcome == Outcome::malformed) ++counts.malformed_packets;
  // Data alone: what tells the time does not tell its model, and a sensor that is refused must not
  // keep out the right one.
  if (outcome == Outcome::used && !on_position_port) sensor_ipv4 = packet.source_ipv4;
  if (outcome == Outcome::used && packet.source_ipv4 == sensor_ipv4)
    sensor_heard_ns = packet.received_ns;
  counts.scans_complete = assembler.scans_complete();
  counts.scans_partial = assembler.scans_partial();
  counts.stalls = assembler.stalls();
}

// The first sensor heard is the one; packets of two would make scans of neither.
bool ScanBuilder::Impl::is_followed(const PacketView& packet) {
  if (sensor_ipv4 == 0 || packet.source_ipv4 == sensor_ipv4) return true;
  return std::abs(packet.received_ns - sensor_heard_ns) > kReplaceableNs;
}

Outcome ScanBuilder::Impl::feed_position(const PacketView& packet) {
  const auto position = parse_position_packet(packet.payload);
  if (!position) return Outcome::malformed;
  ++counts.position_packets;
  if (position->synchronized())
    clock.gps_fix(position->stamp_us, position->gps->utc_ns, packet.received_ns);
  return Outcome::used;
}

Outcome ScanBuilder::Impl::feed_data(const PacketView& packet) {
  if (packet.payload.size() != wire::kDataPacketBytes) return Outcome::malformed;
  const DataPacket data = packet.payload.first<wire::kDataPacketBytes>();
  const std::uint32_t stamp_us = wire::u32(data.data() + wire::kStampOffset);
  if (stamp_us > wire::kMaxStampUs) return Outcome::malformed;
  if (wire::block_flag(data.data(), 0) != wire::kUpperFlag) return Outcome::malformed;
  const SensorIdentity identity = identify(data);
  const SensorTable* table = accept(identity, packet.received_ns);
  if (table == nullptr) {
    refuse(identity);
    return Outcome::refused;
  }
  if (table != &decoder.table()) follow(*table);
  const bool good = table->model == SensorModel::hdl64e
                        ? feed_hdl64e(data, stamp_us, packet.received_ns)
                        : feed_vlp(data, stamp_us, packet.received_ns);
  if (!good) return Outcome::malformed;
  ++counts.data_packets;
  seen_model = table->model;
  model_heard_ns = packet.received_ns;
  return Outcome::used;
}

// The table to read a packet with, null to refuse it.
const SensorTable* ScanBuilder::Impl::accept(const SensorIdentity& identity,
                                             std::int64_t received_ns) const {
  if (!is_readable(identity, model, ignore_product)) return nullptr;
  if (model == SensorModel::automatic) {
    const bool another =
        seen_model != SensorModel::automatic && identity.table->model != seen_model;
    const bool replaceable = std::abs(received_ns - model_heard_ns) > kReplaceableNs;
    return another && !replaceable ? nullptr : identity.table;
  }
  if (!ignore_product && identity.table != nullptr) return identity.table;
  return decoder.table().model == model ? &decoder.table() : find_sensor(model);
}

void ScanBuilder::Impl::refuse(const SensorIdentity& identity) {
  refused.packets = ++counts.wrong_sensor_packets;
  refused.model = identity.table == nullptr ? SensorModel::automatic : identity.table->model;
  refused.product_id = identity.product;
}

void ScanBuilder::Impl::follow(const SensorTable& table) {
  const bool another = seen_model != SensorModel::automatic && table.model != seen_model;
  if (another) {
    assembler.interrupt(clock);
    clock.restart();
    sequence = PacketSequence();
  }
  decoder.use(table);
  if (table.model == SensorModel::hdl64e) {
    hdl64e.take_over();
  } else {
    use_file();
  }
}

void ScanBuilder::Impl::use_file() {
  const Calibration* own = file_of(decoder.table().lasers);
  if (own != nullptr) decoder.use_calibration(*own);
}

bool ScanBuilder::Impl::feed_vlp(DataPacket data, std::uint32_t stamp_us,
                                 std::int64_t received_ns) {
  if (!decoder.load(data)) return false;
  place(stamp_us, clock.unwrap(stamp_us, received_ns), received_ns);
  return true;
}

bool ScanBuilder::Impl::feed_hdl64e(DataPacket data, std::uint32_t stamp_us,
                                    std::int64_t received_ns) {
  const std::int64_t line_ns = clock.unwrap(stamp_us, received_ns);
  if (!hdl64e.load(data, line_ns)) return false;
  if (!hdl64e.times_known()) {
    ++counts.waiting_packets;
    sequence.restart_at(line_ns, received_ns);  // or those that waited would count as lost
    return true;
  }
  const auto lost = place(stamp_us, line_ns, received_ns);
  if (lost && hdl64e.see_status(data, *lost, stamp_us, received_ns, clock))
    assembler.interrupt(clock);
  return true;
}

// What became of the packet that the decoder holds: the one place where it is counted and put into
// its scan. Returns how many were lost right before it; nothing where the order of arrival does not
// tell.
std::optional<std::uint32_t> ScanBuilder::Impl::place(std::uint32_t stamp_us, std::int64_t line_ns,
                                                      std::int64_t received_ns) {
  const auto [arrival, missing] =
      sequence.see(line_ns, received_ns, decoder.packet_period_ns(), decoder.inner_gap_ns());
  if (arrival == PacketSequence::Arrival::restart) {
    restart_line(stamp_us, received_ns);
    return std::nullopt;
  }
  const bool has_returns = decoder.table().model != SensorModel::hdl64e || hdl64e.is_ready();
  if (!has_returns) ++counts.waiting_packets;
  switch (arrival) {
    case PacketSequence::Arrival::duplicate:
      ++counts.packets_duplicated;
      if (has_returns) assembler.note_duplicate();
      return std::nullopt;
    case PacketSequence::Arrival::late:
      ++counts.packets_reordered;
      counts.packets_lost -= std::min<std::uint64_t>(counts.packets_lost, 1);
      if (has_returns && !assembler.add_late(decoder, line_ns)) ++counts.packets_late;
      return std::nullopt;
    default:
      if (has_returns) return add_newest(line_ns, missing);
      counts.packets_lost += missing;
      return missing;
  }
}

// The sensor's clock jumped: the old line ends here.
void ScanBuilder::Impl::restart_line(std::uint32_t stamp_us, std::int64_t received_ns) {
  ++counts.sensor_restarts;
  assembler.interrupt(clock);
  clock.restart();
  const std::int64_t line_ns = clock.unwrap(stamp_us, received_ns);
  sequence.restart_at(line_ns, received_ns);
  if (decoder.table().model == SensorModel::hdl64e) {
    hdl64e.restart();
  } else {
    add_newest(line_ns, 0);
  }
}

// Returns how many of the `missing` packets before it are lost.
std::uint32_t ScanBuilder::Impl::add_newest(std::int64_t line_ns, std::uint32_t missing) {
  const ScanAssembler::Loss loss = assembler.add(decoder, line_ns, missing, clock);
  counts.packets_lost += loss.lost;
  const std::uint64_t blind = std::min(counts.packets_lost, loss.never_sent);
  counts.packets_lost -= blind;
  counts.packets_blind += blind;
  return loss.lost;
}

}  // namespace lilo
