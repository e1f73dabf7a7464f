// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "drivers/sensor_identity.hpp"
#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lilo::doctor {

/// What one address sent to the configured ports.
struct Sender {
  std::uint64_t data = 0, position = 0, other = 0;
  SensorIdentity identity;  ///< of its last data packet
};

/// What came while we listened.
struct Wire {
  double seconds = 0.0;
  bool port_taken = false;                            ///< another program has it
  std::string trouble;                                ///< why nobody could listen; empty: we did
  std::map<std::uint32_t, Sender> senders;            ///< by IPv4 address
  std::map<std::string, std::uint64_t> card_packets;  ///< that each card received meanwhile
};

/// Listens where lilod would. Returns early when a hundred data packets have come.
Wire watch_wire(const UdpConfig& config, double seconds);

/// What a data packet says it is of; empty: it is no data packet.
std::optional<SensorIdentity> identity_of(std::span<const std::byte> payload);
/// "VLP-32C", "unknown sensor (product byte 0x77)".
std::string name_of(const SensorIdentity& identity);

/// What the running lilod says, when it has the port: the health datagram's object, as JSON text.
struct RunningDaemon {
  bool answers = false;
  std::uint64_t packets = 0;
  double silent_s = 0.0;
  std::string complaints;
};

Finding check_packets(const Config& config, const Machine& machine, const Wire& wire,
                      const RunningDaemon& daemon);
Finding check_firewall(const Config& config, const Machine& machine, const Wire& wire);

}  // namespace lilo::doctor
