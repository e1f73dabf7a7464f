// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/sensor_identity.hpp"

#include "drivers/sensor_status.hpp"

#include <array>
#include <cstdio>

namespace lilo {
namespace {

struct Other {
  std::uint8_t product;
  const char* name;
};
// Named so that nobody has to guess what was refused (VeloView's list of products).
constexpr std::array kOthers{Other{0x23, "VLP-32A or VLP-32B"}, Other{0x31, "Velarray"}};

}  // namespace

SensorIdentity identify(DataPacket packet) {
  const bool alternates = wire::block_flag(packet.data(), 1) == wire::kLowerFlag &&
                          wire::block_flag(packet.data(), 2) == wire::kUpperFlag;
  if (alternates) return {find_sensor(SensorModel::hdl64e), 0};
  const std::uint8_t product = wire::u8(packet.data() + wire::kTailOffset + 1);
  return {find_product(product), product};
}

bool is_readable(const SensorIdentity& identity, SensorModel model, bool ignore_product) {
  if (model == SensorModel::automatic) return identity.table != nullptr;
  if (ignore_product) return true;
  if (identity.table != nullptr) return identity.table->model == model;
  return !is_product(identity.product);
}

bool is_product(std::uint8_t product) { return !product_name(product).empty(); }

std::string_view product_name(std::uint8_t product) {
  if (const SensorTable* table = find_product(product)) return table->name;
  for (const Other& other : kOthers)
    if (other.product == product) return other.name;
  return {};
}

std::string_view RefusedSensor::model_name() const {
  if (packets == 0) return {};
  if (model == SensorModel::hdl64e) return find_sensor(model)->name;
  const std::string_view known = product_name(product_id);
  return known.empty() ? "unknown sensor" : known;
}

std::string RefusedSensor::name() const {
  std::string name(model_name());
  if (name.empty() || model == SensorModel::hdl64e) return name;
  std::array<char, 32> byte{};
  std::snprintf(byte.data(), byte.size(), " (product byte 0x%02X)", product_id);
  return name + byte.data();
}

}  // namespace lilo
