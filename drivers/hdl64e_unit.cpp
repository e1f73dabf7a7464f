// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/hdl64e_unit.hpp"

#include "drivers/packet_source.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

namespace lilo {
namespace {

constexpr std::int32_t kS3CycleNs = 57'600;
constexpr std::size_t kLasers = 64;

}  // namespace

Hdl64eUnit::Hdl64eUnit(const SensorConfig& config, const Calibration* file, PacketDecoder& decoder)
    : decoder_(decoder) {
  const std::string stored_file = config.state_directory.empty()
                                      ? std::string()
                                      : stored_calibration_path(config.state_directory);
  std::error_code ignored;  // a folder that cannot be searched has none
  if (file != nullptr) {
    calibration_ = *file;
    origin_ = CalibrationOrigin::file;
  } else if (std::filesystem::is_regular_file(stored_file, ignored)) {
    try {
      Calibration stored = load_calibration(stored_file);
      if (stored.lasers.size() != kLasers) return;
      calibration_ = std::move(stored);
      origin_ = CalibrationOrigin::stored;
    } catch (const DriverError&) {
      origin_ = CalibrationOrigin::none;  // the packets will bring it again
    }
  }
}

void Hdl64eUnit::take_over() {
  restart();
  if (calibration_) decoder_.use_calibration(*calibration_);
}

void Hdl64eUnit::use_calibration(const Calibration& calibration, CalibrationOrigin origin) {
  calibration_ = calibration;
  origin_ = origin;
  if (decoder_.table().model == SensorModel::hdl64e) decoder_.use_calibration(calibration);
}

void Hdl64eUnit::restart() {
  status_.restart();
  period_.restart();
  table_known_ = false;
  decoder_.use_times(nullptr);
}

bool Hdl64eUnit::load(DataPacket packet, std::int64_t line_ns) {
  if (!decoder_.load(packet)) return false;
  if (decoder_.is_dual() != was_dual_) {
    was_dual_ = decoder_.is_dual();
    period_.restart();
    table_known_ = false;
    decoder_.use_times(nullptr);
  }
  if (table_known_) return true;
  find_table(line_ns);
  return decoder_.load(packet);
}

void Hdl64eUnit::find_table(std::int64_t line_ns) {
  period_.see(line_ns);
  const FiringTimes* times =
      find_firing_times(decoder_.table(), period_.median_ns(), decoder_.is_dual());
  decoder_.use_times(times);
  table_known_ = times != nullptr;
}

bool Hdl64eUnit::see_status(DataPacket packet, std::uint32_t lost, std::uint32_t stamp_us,
                            std::int64_t received_ns, SensorClock& clock) {
  const std::uint8_t type = wire::u8(packet.data() + wire::kTailOffset);
  const std::uint8_t value = wire::u8(packet.data() + wire::kTailOffset + 1);
  const bool is_s3 = decoder_.times() != nullptr && decoder_.times()->cycle_ns == kS3CycleNs;
  const Hdl64eStatus::Table table = status_.see(type, value, lost, is_s3);
  if (const auto gps_utc_ns = status_.take_gps_utc_ns())
    clock.gps_fix(stamp_us, *gps_utc_ns, received_ns);
  if (table == Hdl64eStatus::Table::incomplete) return false;
  if (table == Hdl64eStatus::Table::refused) {
    ++refused_;
    return false;
  }
  // A file was the user's choice; a table of this run stays; a stored one gives way to the
  // sensor's.
  if (origin_ == CalibrationOrigin::file) return false;
  if (calibration_ && *calibration_ == status_.calibration()) {
    origin_ = CalibrationOrigin::packets;
    return false;
  }
  use_calibration(status_.calibration(), CalibrationOrigin::packets);
  return true;
}

void Hdl64eUnit::describe(SensorStatus& status) const {
  status.return_mode = decoder_.is_dual() ? ReturnMode::dual : ReturnMode::strongest;
  status.packet_period_us = decoder_.packet_period_ns() * 1e-3;
  status.calibration = origin_;
  status.calibration_progress = status_.progress();
  status.calibrations_refused = refused_;
  status.firmware = status_.firmware();
  status.temperature_c = status_.temperature_c();
}

}  // namespace lilo
