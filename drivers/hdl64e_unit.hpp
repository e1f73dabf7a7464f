// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/hdl64e_status.hpp"
#include "drivers/packet_decoder.hpp"
#include "drivers/packet_period.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/sensor_status.hpp"

#include <optional>
#include <string>

namespace lilo {

/// What one HDL-64E needs beyond its decoder, because its packets say neither when lasers fire nor,
/// at once, where they point: the firing table by the measured packet period, and the calibration
/// from a file, from the state directory or from the status bytes, in this order.
class Hdl64eUnit {
 public:
  /// `file`: the configured calibration, if there is one of 64 lasers. A stored one that cannot be
  /// used is as good as none. `decoder` must outlive the unit and be at the table of the HDL-64E
  /// whenever load() or see_status() is called.
  Hdl64eUnit(const SensorConfig& config, const Calibration* file, PacketDecoder& decoder);
  /// The decoder has just been set to the table of the HDL-64E.
  void take_over();

  /// False: no HDL-64E packet.
  bool load(DataPacket packet, std::int64_t line_ns);
  /// Firing times and calibration are known: the decoder's returns mean something.
  [[nodiscard]] bool is_ready() const { return table_known_ && calibration_.has_value(); }
  [[nodiscard]] bool times_known() const { return table_known_; }

  /// The packet's status bytes. True when they brought a new calibration into force, which the
  /// packets after this one are decoded with.
  bool see_status(DataPacket packet, std::uint32_t lost, std::uint32_t stamp_us,
                  std::int64_t received_ns, SensorClock& clock);
  /// The sensor's clock jumped.
  void restart();

  [[nodiscard]] const Calibration* calibration() const {
    return calibration_ ? &*calibration_ : nullptr;
  }
  void use_calibration(const Calibration& calibration, CalibrationOrigin origin);
  void describe(SensorStatus& status) const;

 private:
  void find_table(std::int64_t line_ns);

  PacketDecoder& decoder_;
  Hdl64eStatus status_;
  PacketPeriod period_;
  bool was_dual_ = false;
  bool table_known_ = false;
  std::optional<Calibration> calibration_;
  CalibrationOrigin origin_ = CalibrationOrigin::none;
  std::uint64_t refused_ = 0;
};

}  // namespace lilo
