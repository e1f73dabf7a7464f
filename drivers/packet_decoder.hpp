#pragma once

#include "core/scan.hpp"
#include "drivers/wire.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lilo {

using DataPacket = std::span<const std::byte, wire::kDataPacketBytes>;

/// The smallest piece of a packet a scan can be cut at: the lasers that fire in one sequence.
struct Column {
  double azimuth_ticks = 0.0;  ///< of its first firing, clockwise, in [0, 36000)
  std::int32_t first_ns = 0;   ///< its first firing after the packet's stamp
  std::int32_t last_ns = 0;    ///< its last firing after the packet's stamp
};

/// One model's packets: where the columns are, then the returns of each. One virtual call a column.
class PacketDecoder {
 public:
  PacketDecoder() = default;
  PacketDecoder(const PacketDecoder&) = delete;
  PacketDecoder& operator=(const PacketDecoder&) = delete;
  virtual ~PacketDecoder() = default;

  /// Reads azimuths and mode. False: not a packet of this model, nothing may be asked of it.
  /// The packet's bytes must outlive the calls below.
  virtual bool load(DataPacket packet) = 0;
  /// In firing order.
  [[nodiscard]] virtual std::span<const Column> columns() const = 0;
  /// Turning speed within the packet, negative when the azimuth decreases.
  [[nodiscard]] virtual double ticks_per_ns() const = 0;
  /// Time from one packet's stamp to the next one's; 0 while it is not known.
  [[nodiscard]] virtual double packet_period_ns() const = 0;
  /// Time within the packet in which nothing fired (a blind sector): the next stamp is as much
  /// later.
  [[nodiscard]] virtual std::int64_t inner_gap_ns() const { return 0; }
  [[nodiscard]] virtual const BeamTable& beams() const = 0;
  /// The most returns that one column can have in the mode of this packet.
  [[nodiscard]] virtual std::size_t max_column_returns() const = 0;
  /// Adds the returns of one column, in firing order; `t_ns` is the time of its first firing.
  virtual void append(std::size_t column, std::int32_t t_ns, Returns& out) const = 0;
};

}  // namespace lilo
