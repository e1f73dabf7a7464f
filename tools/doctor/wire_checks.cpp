// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/sensor_status.hpp"
#include "tools/doctor/wire.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lilo::doctor {
namespace {

constexpr double kSilentAfterS = 1.0;

std::string sentence(std::uint32_t address, const Sender& sender, double seconds) {
  std::string text = fmt::format("{} {}: {:.0f} packets/s", name_of(sender.identity),
                                 ipv4_text(address), static_cast<double>(sender.data) / seconds);
  if (sender.position > 0) text += " and position packets";
  return text;
}

std::vector<std::pair<std::uint32_t, Sender>> sensors_of(const Wire& wire) {
  std::vector<std::pair<std::uint32_t, Sender>> out;
  for (const auto& each : wire.senders) {
    if (each.second.data > 0) out.emplace_back(each);
  }
  return out;
}

Finding from_daemon(const Config& config, const RunningDaemon& daemon) {
  const std::string port = fmt::format("UDP {}", config.udp.data_port);
  if (!daemon.answers) {
    return {Verdict::bad, "Packets", port + " is another program's, and no lilod answers here",
            fmt::format("ss -ulpn 'sport = :{}' says whose", config.udp.data_port)};
  }
  if (daemon.packets == 0 || daemon.silent_s > kSilentAfterS) {
    return {Verdict::bad, "Packets",
            fmt::format("the running lilod has had none for {:.0f} s", daemon.silent_s),
            "stop it (systemctl stop lilod, or lilod@NAME) and ask again: then I can look myself"};
  }
  const std::string text = fmt::format("the running lilod has had {}", daemon.packets);
  if (daemon.complaints.empty()) return {Verdict::good, "Packets", text, ""};
  return {Verdict::warning, "Packets", text + "; it complains: " + daemon.complaints,
          "lilo status says more"};
}

Finding of_several(const std::vector<std::pair<std::uint32_t, Sender>>& sensors, double seconds) {
  std::string text;
  for (const auto& [address, sender] : sensors)
    text += (text.empty() ? "" : "; ") + sentence(address, sender, seconds);
  return {Verdict::bad, "Packets", text,
          fmt::format("set udp.sensor_address to one of them, e.g. {}",
                      ipv4_text(sensors.front().first))};
}

/// What lilod would not read.
Finding of_refused(SensorModel configured, const SensorIdentity& identity,
                   const std::string& text) {
  const bool known = identity.table != nullptr;
  if (configured != SensorModel::automatic) {
    return {Verdict::bad, "Packets",
            fmt::format("{}, but sensor.model is {}", text, find_sensor(configured)->name),
            known ? "set sensor.model: auto" : "lilod cannot read them"};
  }
  // An unknown byte may be that of old firmware, which leaves it to chance.
  return {Verdict::bad, "Packets", text,
          is_product(identity.product) ? "lilod cannot read them" : "set sensor.model"};
}

Finding of_one(const Config& config, std::uint32_t address, const Sender& sender, double seconds) {
  const std::string text = sentence(address, sender, seconds);
  const std::string& wanted = config.udp.sensor_address;
  if (!wanted.empty() && wanted != ipv4_text(address)) {
    return {Verdict::bad, "Packets", fmt::format("{}, but udp.sensor_address is {}", text, wanted),
            "set udp.sensor_address: " + ipv4_text(address)};
  }
  if (!is_readable(sender.identity, config.sensor.model, config.sensor.ignore_product_byte))
    return of_refused(config.sensor.model, sender.identity, text);
  return {Verdict::good, "Packets", text, ""};
}

/// The card that got most meanwhile, loopback aside.
std::string busiest_card(const Wire& wire) {
  std::string best;
  std::uint64_t most = 0;
  for (const auto& [card, packets] : wire.card_packets) {
    if (card == "lo" || packets <= most) continue;
    best = card;
    most = packets;
  }
  return best.empty() ? "no card received anything"
                      : fmt::format("{} received {:.0f} packets/s of all kinds", best,
                                    static_cast<double>(most) / std::max(wire.seconds, 0.1));
}

Finding of_none(const Config& config, const Wire& wire) {
  return {Verdict::bad, "Packets",
          fmt::format("none of a sensor on UDP {} in {:.1f} s; {}", config.udp.data_port,
                      wire.seconds, busiest_card(wire)),
          "is it plugged in, powered and turning? Its web page (http://192.168.1.201 by default) "
          "says where it sends"};
}

}  // namespace

std::string name_of(const SensorIdentity& identity) {
  if (identity.table != nullptr) return identity.table->name;
  return RefusedSensor{.packets = 1, .product_id = identity.product}.name();
}

Finding check_packets(const Config& config, const Machine& /*machine*/, const Wire& wire,
                      const RunningDaemon& daemon) {
  if (wire.port_taken) return from_daemon(config, daemon);
  if (!wire.trouble.empty()) return {Verdict::bad, "Packets", wire.trouble, ""};
  auto sensors = sensors_of(wire);
  if (sensors.empty()) return of_none(config, wire);
  if (sensors.size() > 1 && !config.udp.sensor_address.empty()) {
    std::erase_if(sensors, [&](const auto& each) {
      return ipv4_text(each.first) != config.udp.sensor_address;
    });
  }
  if (sensors.empty() || sensors.size() > 1) return of_several(sensors_of(wire), wire.seconds);
  return of_one(config, sensors.front().first, sensors.front().second, wire.seconds);
}

Finding check_firewall(const Config& config, const Machine& machine, const Wire& wire) {
  if (!sensors_of(wire).empty()) return {Verdict::good, "Firewall", "lets them through", ""};
  if (wire.port_taken) return {Verdict::good, "Firewall", "not looked at: lilod has the port", ""};
  std::string names;
  for (const std::string& name : machine.firewalls) names += (names.empty() ? "" : ", ") + name;
  for (const Card& card : machine.cards) {
    if (!card.loopback && card.rp_filter == 1)
      names += fmt::format("{}rp_filter of {}", names.empty() ? "" : ", ", card.name);
  }
  if (names.empty()) return {Verdict::good, "Firewall", "none found", ""};
  const std::uint16_t port = config.udp.data_port;
  return {Verdict::warning, "Firewall", names + " may hold them back",
          fmt::format("ufw allow {}/udp; firewall-cmd --add-port={}/udp; sysctl -w "
                      "net.ipv4.conf.all.rp_filter=2",
                      port, port)};
}

}  // namespace lilo::doctor
