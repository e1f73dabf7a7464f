// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/machine_checks.hpp"
#include "tools/doctor/wire.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cerrno>
#include <string>

namespace lilo::doctor {
namespace {

constexpr std::uint32_t kSensor = 0xC0A801C9;    // 192.168.1.201
constexpr std::uint32_t kComputer = 0xC0A80164;  // 192.168.1.100
constexpr std::uint32_t kMask = 0xFFFFFF00;

Machine a_machine() {
  Machine machine;
  machine.cards = {
      {.name = "lo", .ipv4 = 0x7F000001, .mask = 0xFF000000, .up = true, .loopback = true},
      {.name = "eth0", .ipv4 = kComputer, .mask = kMask, .up = true}};
  machine.rmem_max_bytes = 8 << 20;
  machine.cpus = 4;
  machine.clock = {.synchronized = true, .max_error_s = 0.004, .programs = {"chronyd"}};
  return machine;
}

SensorIdentity named(SensorModel model) {
  return {find_sensor(model), find_sensor(model)->product};
}

Wire a_wire(const SensorIdentity& identity = named(SensorModel::vlp16)) {
  Wire wire;
  wire.seconds = 0.5;
  wire.senders[kSensor] = {.data = 377, .position = 1, .identity = identity};
  return wire;
}

TEST(Doctor, TheCardMustReachTheSensor) {
  Config config;
  EXPECT_EQ(check_card(config, a_machine()).verdict, Verdict::good);
  EXPECT_EQ(check_card(config, a_machine()).text, "eth0 192.168.1.100/24");
  config.udp.sensor_address = "192.168.1.201";
  EXPECT_EQ(check_card(config, a_machine()).verdict, Verdict::good);
  config.udp.sensor_address = "10.0.0.5";
  const Finding other = check_card(config, a_machine());
  EXPECT_EQ(other.verdict, Verdict::bad);
  EXPECT_EQ(other.cure, "ip address add 10.0.0.100/24 dev CARD");
  config.udp.sensor_address.clear();
  config.udp.bind_address = "192.168.7.7";
  EXPECT_EQ(check_card(config, a_machine()).verdict, Verdict::bad);
  config.udp.bind_address = "192.168.1.100";
  EXPECT_EQ(check_card(config, a_machine()).verdict, Verdict::good);
}

TEST(Doctor, ACardWithoutALinkIsBad) {
  Config config;
  config.udp.sensor_address = "192.168.1.201";
  Machine machine = a_machine();
  machine.cards[1].up = false;
  EXPECT_EQ(check_card(config, machine).verdict, Verdict::bad);
}

TEST(Doctor, PacketsTellWhoSendsThem) {
  const Finding finding = check_packets({}, a_machine(), a_wire(), {});
  EXPECT_EQ(finding.verdict, Verdict::good);
  EXPECT_EQ(finding.text, "VLP-16 192.168.1.201: 754 packets/s and position packets");
}

// Every model that the drivers read, and no other.
TEST(Doctor, SensorsThatLilodReadsAreGood) {
  for (const SensorTable* sensor : sensor_tables()) {
    const Wire wire = a_wire({sensor, sensor->product});
    Config config;
    const Finding found = check_packets(config, a_machine(), wire, {});
    EXPECT_EQ(found.verdict, Verdict::good) << found.text;
    EXPECT_EQ(found.text.rfind(std::string(sensor->name) + " 192.168.1.201: ", 0), 0U);
    config.sensor.model = sensor->model;
    EXPECT_EQ(check_packets(config, a_machine(), wire, {}).verdict, Verdict::good) << sensor->name;
  }
}

TEST(Doctor, AnotherSensorIsRefusedByName) {
  Config config;
  const Finding never = check_packets(config, a_machine(), a_wire({nullptr, 0x23}), {});
  EXPECT_EQ(never.verdict, Verdict::bad);
  EXPECT_EQ(never.text.rfind("VLP-32A or VLP-32B (product byte 0x23) 192.168.1.201: ", 0), 0U);
  EXPECT_EQ(never.cure, "lilod cannot read them");
  config.sensor.model = SensorModel::vlp16;
  for (const SensorModel model :
       {SensorModel::hdl64e, SensorModel::vlp32c, SensorModel::hdl32e, SensorModel::vls128}) {
    const Finding other = check_packets(config, a_machine(), a_wire(named(model)), {});
    EXPECT_EQ(other.verdict, Verdict::bad);
    EXPECT_NE(other.text.find(", but sensor.model is VLP-16"), std::string::npos) << other.text;
    EXPECT_EQ(other.cure, "set sensor.model: auto");
  }
  config.sensor.ignore_product_byte = true;
  EXPECT_EQ(check_packets(config, a_machine(), a_wire(named(SensorModel::vlp32c)), {}).verdict,
            Verdict::good);
  config.udp.sensor_address = "192.168.1.202";
  EXPECT_EQ(check_packets(config, a_machine(), a_wire(), {}).verdict, Verdict::bad);
}

// Old firmware leaves the product byte to chance: the configuration has to say the model.
TEST(Doctor, AnUnknownProductNeedsAModel) {
  Config config;
  const Wire wire = a_wire({nullptr, 0x77});
  const Finding unknown = check_packets(config, a_machine(), wire, {});
  EXPECT_EQ(unknown.verdict, Verdict::bad);
  EXPECT_EQ(unknown.cure, "set sensor.model");
  config.sensor.model = SensorModel::vlp16;
  EXPECT_EQ(check_packets(config, a_machine(), wire, {}).verdict, Verdict::good);
}

TEST(Doctor, TwoSensorsNeedAnAddress) {
  Config config;
  Wire wire = a_wire();
  wire.senders[kSensor + 1] = {.data = 377, .identity = named(SensorModel::vlp16)};
  EXPECT_EQ(check_packets(config, a_machine(), wire, {}).verdict, Verdict::bad);
  config.udp.sensor_address = "192.168.1.202";
  EXPECT_EQ(check_packets(config, a_machine(), wire, {}).verdict, Verdict::good);
}

TEST(Doctor, SilenceNamesWhatMayHoldPacketsBack) {
  Machine machine = a_machine();
  machine.firewalls = {"ufw"};
  machine.cards[1].rp_filter = 1;
  Wire wire{.seconds = 3.0, .card_packets = {{"lo", 5000}, {"eth0", 2262}}};
  const Finding packets = check_packets({}, machine, wire, {});
  EXPECT_EQ(packets.verdict, Verdict::bad);
  EXPECT_NE(packets.text.find("eth0 received 754 packets/s"), std::string::npos) << packets.text;
  const Finding firewall = check_firewall({}, machine, wire);
  EXPECT_EQ(firewall.verdict, Verdict::warning);
  EXPECT_EQ(firewall.text, "ufw, rp_filter of eth0 may hold them back");
  EXPECT_EQ(check_firewall({}, machine, a_wire()).verdict, Verdict::good);
}

TEST(Doctor, ATakenPortIsTheDaemonsOrAStrangers) {
  const Wire wire{.port_taken = true};
  EXPECT_EQ(check_packets({}, a_machine(), wire, {}).verdict, Verdict::bad);
  EXPECT_EQ(check_packets({}, a_machine(), wire, {.answers = true, .packets = 5}).verdict,
            Verdict::good);
  EXPECT_EQ(
      check_packets({}, a_machine(), wire, {.answers = true, .packets = 5, .silent_s = 9}).verdict,
      Verdict::bad);
  EXPECT_EQ(check_packets({}, a_machine(), wire,
                          {.answers = true, .packets = 5, .complaints = "packets lost"})
                .verdict,
            Verdict::warning);
}

TEST(Doctor, RealTimeNeedsWhatWasAskedFor) {
  Config config;
  Machine machine = a_machine();
  machine.rmem_max_bytes = 212992;
  EXPECT_EQ(check_receive_buffer(config, machine).verdict, Verdict::warning);
  EXPECT_EQ(check_receive_buffer(config, a_machine()).verdict, Verdict::good);
  EXPECT_EQ(check_priority(config, machine).verdict, Verdict::good);
  config.realtime.worker_priority = 50;
  machine.fifo_errno = EPERM;
  EXPECT_EQ(check_priority(config, machine).verdict, Verdict::warning);
  machine.unit_installed = true;  // the unit has limits of its own
  EXPECT_EQ(check_priority(config, machine).verdict, Verdict::good);
  config.realtime.lock_memory = true;
  machine.unit_installed = false;
  EXPECT_EQ(check_memory_lock(config, machine).verdict, Verdict::warning);
  config.realtime.worker_cpu = 4;
  EXPECT_EQ(check_cpu(config, machine).verdict, Verdict::bad);
  config.realtime.worker_cpu = 3;
  EXPECT_EQ(check_cpu(config, machine).verdict, Verdict::good);
  machine.governor = "powersave";
  EXPECT_EQ(check_cpu(config, machine).verdict, Verdict::warning);
}

TEST(Doctor, ClockAndDisk) {
  Machine machine = a_machine();
  EXPECT_EQ(check_clock(machine).text, "synchronized within 4.0 ms by chronyd");
  machine.clock = {};
  EXPECT_EQ(check_clock(machine).verdict, Verdict::warning);
  EXPECT_EQ(check_disk(machine).verdict, Verdict::good);
  machine.disk = {
      .folder = "/var/lib/lilod", .exists = true, .writable = true, .free_bytes = 1 << 20};
  EXPECT_EQ(check_disk(machine).verdict, Verdict::warning);
  machine.disk = {.folder = "/srv/lilod", .exists = true, .free_bytes = 1 << 30};
  EXPECT_EQ(check_disk(machine).text,
            "/srv/lilod: 1024 MB free, but this user may not write there");
  machine.disk.writable = true;
  EXPECT_EQ(check_disk(machine).verdict, Verdict::good);
  machine.disk.exists = false;
  EXPECT_EQ(check_disk(machine).verdict, Verdict::warning);
  // The link that systemd makes: /var/lib/private is root's alone.
  machine.disk = {.folder = "/var/lib/lilod", .hidden = true, .free_bytes = 1 << 30};
  machine.unit_installed = true;
  EXPECT_EQ(check_disk(machine).verdict, Verdict::good);
}

// The last byte but one is the return mode, the last the product (VLP-16 manual 9.3.1.6).
TEST(Doctor, ModelsByTheirPackets) {
  std::array<std::byte, 1206> packet{};
  for (std::size_t block = 0; block < 12; ++block) {
    packet[100 * block] = std::byte{0xFF};
    packet[100 * block + 1] = std::byte{0xEE};
  }
  const auto name = [&] { return name_of(identity_of(packet).value()); };
  packet[1205] = std::byte{0x22};
  EXPECT_EQ(name(), "VLP-16");
  packet[1205] = std::byte{0x28};
  EXPECT_EQ(name(), "VLP-32C");
  packet[1205] = std::byte{0x77};
  EXPECT_EQ(name(), "unknown sensor (product byte 0x77)");
  packet[101] = std::byte{0xDD};
  EXPECT_EQ(name(), "HDL-64E");
  EXPECT_FALSE(identity_of(std::span(packet).first(512)));
}

// A daemon that shares its ports must name its sensor; the doctor looks at all senders.
TEST(Doctor, SharedPortsAreWatched) {
  UdpConfig config;
  config.bind_address = "127.0.0.1";
  config.data_port = config.position_port = 0;  // any
  config.sensor_address = "127.0.0.1";
  config.share_ports = true;
  EXPECT_EQ(watch_wire(config, 0.1).trouble, "");
}

TEST(Doctor, OneFailureIsEnough) {
  std::vector<Finding> findings{{Verdict::good, "A", "well", ""},
                                {Verdict::warning, "B", "so so", "try"}};
  EXPECT_TRUE(is_ready(findings));
  EXPECT_EQ(to_text(findings, Paint(false)),
            "ok    A               well\n"
            "warn  B               so so\n"
            "                      -> try\n");
  findings.push_back({Verdict::bad, "C", "broken", "mend"});
  EXPECT_FALSE(is_ready(findings));
  const auto object = nlohmann::json::parse(to_json(findings));
  EXPECT_EQ(object["ready"], false);
  EXPECT_EQ(object["findings"][2]["verdict"], "FAIL");
}

}  // namespace
}  // namespace lilo::doctor
