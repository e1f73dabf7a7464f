// SPDX-License-Identifier: BSD-3-Clause
// The same capture gives the same poses: run again, on one core or on several, as a file or as
// packets that arrive.
#include "tests/daemon/lilod_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sched.h>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace lilo {
namespace {

using nlohmann::json;
using std::chrono::seconds;

/// While it lives, what is started may use the first `count` CPUs of those this test may use.
class OnCpus {
 public:
  explicit OnCpus(int count) {
    sched_getaffinity(0, sizeof(before_), &before_);
    cpu_set_t fewer;
    CPU_ZERO(&fewer);
    for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&fewer) < count; ++cpu) {
      if (CPU_ISSET(cpu, &before_)) CPU_SET(cpu, &fewer);
    }
    is_in_force_ = CPU_COUNT(&fewer) == count && sched_setaffinity(0, sizeof(fewer), &fewer) == 0;
  }
  ~OnCpus() { sched_setaffinity(0, sizeof(before_), &before_); }
  OnCpus(const OnCpus&) = delete;
  OnCpus& operator=(const OnCpus&) = delete;
  [[nodiscard]] bool is_in_force() const { return is_in_force_; }

 private:
  cpu_set_t before_{};
  bool is_in_force_ = false;
};

/// A drive of `lilo sim`: same options, same bytes.
struct Drive {
  const char* name;
  std::vector<std::string> options;
  bool calibration_file = false;
};
std::ostream& operator<<(std::ostream& out, const Drive& drive) { return out << drive.name; }

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

class SameBits : public testing::TestWithParam<Drive> {
 protected:
  SameBits() : folder_(testing::TempDir() + "lilo_same_bits_" + std::to_string(getpid())) {}
  ~SameBits() override { std::filesystem::remove_all(folder_); }

  void SetUp() override {
    std::vector<std::string> sim{kLilo, "sim", folder_, "--quiet"};
    sim.insert(sim.end(), GetParam().options.begin(), GetParam().options.end());
    ASSERT_EQ(run_to_end(sim).exit_code, 0);
    sensor_ = GetParam().calibration_file ? "calibration_file: " + folder_ + "/calibration.yaml"
                                          : "model: auto";
    std::ofstream(folder_ + "/run.yaml") << "sensor:\n  " << sensor_ << '\n';
  }

  /// The lines of the file that `lilo run --tum` writes.
  [[nodiscard]] std::vector<std::string> run(int cpus) const {
    const OnCpus on_cpus(cpus);
    EXPECT_TRUE(on_cpus.is_in_force());
    const std::string tum = folder_ + "/poses.tum";
    const Finished finished = run_to_end(
        {kLilo, "run", folder_ + "/data.pcap", "--config", folder_ + "/run.yaml", "--tum", tum});
    EXPECT_EQ(finished.exit_code, 0) << finished.error;
    return lines_of(tum);
  }

  /// What lilod sends while the capture arrives at sensor speed; what hangs on the computer's time
  /// is left out. `scans`: to wait for.
  [[nodiscard]] std::vector<json> serve(int cpus, std::size_t scans) const {
    const auto start = [&] {
      const OnCpus on_cpus(cpus);
      EXPECT_TRUE(on_cpus.is_in_force());
      return std::make_unique<Lilod>("realtime:\n  ring_slots: 64\n",
                                     std::map<std::string, std::string>{}, sensor_);
    };
    const std::unique_ptr<Lilod> lilod = start();
    if (!lilod->wait_ready()) return {};
    ChildProcess replay({kLilo, "replay", folder_ + "/data.pcap", "--data-port",
                         std::to_string(lilod->data_port()), "--position-port",
                         std::to_string(lilod->position_port())});
    std::vector<json> poses;
    while (poses.size() < scans) {
      const auto datagram = lilod->sink().receive(seconds(5));
      if (!datagram) break;
      json message = json::parse(*datagram);
      if (!message.contains("pose")) continue;
      message.erase("session");
      message["pose"].erase("latency_ms");
      poses.push_back(std::move(message));
    }
    EXPECT_EQ(replay.wait(seconds(60)), 0) << replay.standard_error();
    EXPECT_EQ(lilod->stop(), 0);
    return poses;
  }

  static constexpr const char* kLilo = LILO_BIN_DIR "/lilo";
  std::string folder_, sensor_;
};

/// Half of the last digit: 7 decimals of metres on the wire, 9 of the quaternion in the file, and
/// what the other, finer one of the two cuts off.
constexpr double kPositionDigit_m = 0.5e-7 + 0.6e-9, kQuaternionDigit = 0.5e-9 + 0.6e-10;

void expect_equal_digits(const json& message, const std::string& line) {
  std::istringstream text(line);
  std::string stamp;
  double expected[7] = {};
  text >> stamp;
  for (double& value : expected) text >> value;
  const json& p = message["pose"]["position"];
  const json& q = message["pose"]["orientation"];
  const std::string nsec =
      std::to_string(message["pose"]["stamp"]["nsec"].get<int>() + 1'000'000'000);
  EXPECT_EQ(message["pose"]["stamp"]["sec"].dump() + '.' + nsec.substr(1), stamp);
  EXPECT_NEAR(p["x"], expected[0], kPositionDigit_m);
  EXPECT_NEAR(p["y"], expected[1], kPositionDigit_m);
  EXPECT_NEAR(p["z"], expected[2], kPositionDigit_m);
  EXPECT_NEAR(q["x"], expected[3], kQuaternionDigit);
  EXPECT_NEAR(q["y"], expected[4], kQuaternionDigit);
  EXPECT_NEAR(q["z"], expected[5], kQuaternionDigit);
  EXPECT_NEAR(q["w"], expected[6], kQuaternionDigit);
}

// Issue 5: bit-identical from run to run, and on one core or two. A pose hangs on all before it, so
// one bit elsewhere in the first scan is many digits at the end.
TEST_P(SameBits, RunAgainOnOneCoreAndOnTwo) {
  const std::vector<std::string> first = run(1);
  ASSERT_GT(first.size(), 10U);
  EXPECT_EQ(run(1), first) << "from run to run";
  if (!OnCpus(2).is_in_force()) GTEST_SKIP() << "needs two CPUs";
  EXPECT_EQ(run(2), first) << "one core and two";
}

// Issue 5: the same from lilod, to every digit that a datagram has; and on one core or two lilod
// says the same, number by number, velocity and covariance included.
TEST_P(SameBits, ServedOnOneCoreAndOnTwo) {
  const std::vector<std::string> file = run(1);
  const std::vector<json> one = serve(1, file.size());
  ASSERT_EQ(one.size(), file.size());
  for (std::size_t k = 0; k < file.size(); ++k) {
    SCOPED_TRACE("scan " + std::to_string(k));
    expect_equal_digits(one[k], file[k]);
  }
  EXPECT_GT(std::abs(one.back()["pose"]["position"]["x"].get<double>()), 1.0)
      << "the comparison says nothing when all poses are the identity";
  if (!OnCpus(2).is_in_force()) GTEST_SKIP() << "needs two CPUs";
  EXPECT_EQ(serve(2, file.size()), one);
}

const Drive kDrives[] = {
    {"vlp16_street", {"--duration-s", "4", "--start-in-motion"}},
    {"hdl64_country",
     {"--sensor", "hdl64-s2", "--world", "country", "--duration-s", "1.6", "--start-in-motion"},
     true},
};
INSTANTIATE_TEST_SUITE_P(Drives, SameBits, testing::ValuesIn(kDrives),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace lilo
