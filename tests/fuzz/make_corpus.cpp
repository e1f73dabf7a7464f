// SPDX-License-Identifier: BSD-3-Clause
// Writes the seeds of tests/fuzz/corpus: one good input of each kind. Run once, by hand.
#include "tests/drivers/capture_file.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;
using lilo::SensorModel;
using namespace lilo::test;  // NOLINT(google-build-using-namespace): the encoders

void write(const fs::path& file, const std::string& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string stream(const std::vector<TimedPacket>& packets) {
  std::string out;
  for (const TimedPacket& packet : packets) {
    out += packet.port == 8308 ? '\4' : '\0';
    out += std::string("\x2F\x05", 2);  // 1327 us
    for (const std::byte b : packet.bytes) out += std::to_integer<char>(b);
  }
  return out;
}

std::string text_of(const std::vector<std::byte>& bytes) {
  std::string out;
  for (const std::byte b : bytes) out += std::to_integer<char>(b);
  return out;
}

std::string status(bool s3) {
  std::string out;
  const HdlOptions options{
      .calibration = sample_calibration(true), .s3 = s3, .without_returns = true};
  for (const TimedPacket& packet : hdl64e_packets(4200, options)) {
    out += std::to_integer<char>(packet.bytes[1204]);
    out += std::to_integer<char>(packet.bytes[1205]);
  }
  return out;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "make_corpus FOLDER\n"), 2;
  const fs::path root = arguments[1];
  const auto position = position_packet(1'000'000'000, 2, gprmc(9, 16, 40, 14, 5, 2024), 0);
  auto vlp16 = vlp16_packets(8, {});
  vlp16.push_back(position);
  write(root / "packets/vlp16", stream(vlp16));
  write(root / "packets/vlp16_dual", stream(vlp16_packets(8, {.mode = Mode::dual})));
  for (const SensorModel model : {SensorModel::vlp32c, SensorModel::hdl32e, SensorModel::vls128}) {
    for (const Mode mode : {Mode::strongest, Mode::dual}) {
      const RowOptions options{.model = model, .drive = {.mode = mode}};
      const std::string name =
          std::string(model == SensorModel::vlp32c
                          ? "vlp32c"
                          : (model == SensorModel::hdl32e ? "hdl32e" : "vls128")) +
          (mode == Mode::dual ? "_dual" : "");
      write(root / "packets" / name, stream(row_packets(6, options)));
    }
  }
  RowOptions confirmed{.model = SensorModel::vls128, .drive = {.mode = Mode::dual}};
  confirmed.dual_byte = 0x3B;
  write(root / "packets/vls128_confirmed", stream(row_packets(6, confirmed)));
  const HdlOptions hdl{.calibration = sample_calibration(true), .without_returns = true};
  write(root / "packets/hdl64e", stream(hdl64e_packets(16, hdl)));
  write(root / "position/good", text_of(position.bytes).substr(0xC6, 100));
  write(root / "position/sentence", gprmc(9, 16, 40, 14, 5, 2024));
  write(root / "status/s2", status(false) + " ");  // an odd length: without a checksum
  write(root / "status/s3", status(true));
  const auto records = records_of({vlp16[0], position});
  write(root / "pcap/microseconds", pcap_bytes(records));
  write(root / "pcap/nanoseconds", pcap_bytes(records, {.nanoseconds = true, .big_endian = true}));
  write(root / "pcap/ng", pcapng_bytes(records));
  write(root / "pcap/vlan", text_of(ethernet(ipv4(udp_datagram({64, std::byte{1}}), 8), {0x8100})));
  const std::string yaml = (fs::temp_directory_path() / "lilo_corpus.yaml").string();
  lilo::store_calibration(yaml, sample_calibration(true));
  fs::create_directories(root / "calibration");
  fs::rename(yaml, root / "calibration/yaml");
  write(root / "calibration/xml",
        "<?xml version=\"1.0\"?><!DOCTYPE boost_serialization><boost_serialization><DB>"
        "<distLSB_>0.2</distLSB_><minIntensity_><count>64</count><item>30</item></minIntensity_>"
        "<points_><count>64</count><item><px><id_>0</id_><rotCorrection_>-7.16</rotCorrection_>"
        "<vertCorrection_>-8.77</vertCorrection_><distCorrection_>152</distCorrection_>"
        "<vertOffsetCorrection_>19.5</vertOffsetCorrection_>"
        "<horizOffsetCorrection_>2.6</horizOffsetCorrection_></px></item></points_></DB>"
        "</boost_serialization>");
  return 0;
}
