// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/packet_decoder.hpp"
#include "drivers/sensor_table.hpp"

#include <cstdint>
#include <string_view>

namespace lilo {

/// Whose data packet this says it is.
struct SensorIdentity {
  const SensorTable* table = nullptr;  ///< null: of no sensor that can be read here
  std::uint8_t product = 0;            ///< 0: HDL-64E, whose packets name none
};

/// By the flags of the blocks, which only an HDL-64E alternates, then by the product byte.
SensorIdentity identify(DataPacket packet);

/// Whether `model` may be read from such packets. Old firmware leaves the product byte to chance:
/// then the configuration must name the model. `ignore_product` as
/// SensorConfig::ignore_product_byte.
bool is_readable(const SensorIdentity& identity, SensorModel model, bool ignore_product);

/// The byte is that of a sensor, so it is not left to chance (old firmware).
bool is_product(std::uint8_t product);

/// "VLP-32C", "Puck Hi-Res", also of sensors that cannot be read here; empty: not known.
std::string_view product_name(std::uint8_t product);

}  // namespace lilo
