// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/conversation.hpp"
#include "tests/daemon/text_of.hpp"

#include <Eigen/Core>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace lilo {
namespace {

/// A lilod with a state directory, as systemd gives it one.
class Save : public testing::Test {
 protected:
  Save() { std::filesystem::create_directories(folder_); }
  ~Save() override { std::filesystem::remove_all(folder_); }

  static std::vector<std::string> lines_of(const std::string& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }

  const std::string folder_ = testing::TempDir() + "lilo_state_" + std::to_string(getpid());
};

// All poses that were sent, as they were sent.
TEST_F(Save, TheTrajectoryIsWhatWasPublished) {
  // Slots for all of the turns: nothing may be dropped on a machine that is slow.
  Lilod lilod("realtime:\n  ring_slots: 16\n", {{"STATE_DIRECTORY", folder_}});
  ASSERT_TRUE(lilod.wait_ready());
  Sensor().turn(lilod, 6.0);
  std::vector<json> poses;
  while (poses.size() < 4) poses.push_back(next_of_kind(lilod.sink(), "pose").value());
  UdpSocket client;
  const json done = ask(client, lilod, R"({"save":"trajectory"})", "done")["done"];
  EXPECT_EQ(done["request"], "save");
  ASSERT_EQ(done["file"], folder_ + "/trajectory.tum");
  const std::vector<std::string> lines = lines_of(done["file"]);
  ASSERT_EQ(lines.size(), 2 + done["count"].get<std::size_t>());
  ASSERT_GE(lines.size(), 2 + poses.size());
  EXPECT_NE(lines[0].find(poses[0]["session"].get<std::string>()), std::string::npos) << lines[0];
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const json& p = poses[k]["pose"];
    double t = 0, x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    std::istringstream(lines[2 + k]) >> t >> x >> y >> z >> qx >> qy >> qz >> qw;
    EXPECT_NEAR(t, poses[k]["timestamp"].get<double>(), 1e-6);
    EXPECT_NEAR(x, p["position"]["x"].get<double>(), 1e-6);
    EXPECT_NEAR(z, p["position"]["z"].get<double>(), 1e-6);
    EXPECT_NEAR(qw, p["orientation"]["w"].get<double>(), 1e-6);
  }
}

// The round room, 10 m from wall to sensor, around where the client said the session starts; also
// while the sensor is silent.
TEST_F(Save, TheMapLiesWhereThePosesDo) {
  Lilod lilod("state:\n  directory: " + folder_ + "\n");
  ASSERT_TRUE(lilod.wait_ready());
  UdpSocket client;
  ask(client, lilod,
      R"({"reset":{"pose":{"position":{"x":100,"y":0,"z":0},)"
      R"("orientation":{"x":0,"y":0,"z":0,"w":1}}}})",
      "done");
  Sensor().turn(lilod, 5.0);
  ASSERT_TRUE(next_of_kind(lilod.sink(), "pose"));
  std::this_thread::sleep_for(milliseconds(300));
  const json done = ask(client, lilod, R"({"save":"map"})", "done")["done"];
  ASSERT_EQ(done["file"], folder_ + "/map.pcd");
  ASSERT_GT(done["count"], 50);
  const std::string pcd = text_of(folder_ + "/map.pcd");
  const std::size_t data = pcd.find("DATA binary\n") + 12;
  ASSERT_EQ(pcd.size() - data, done["count"].get<std::size_t>() * 12);
  for (std::size_t at = data; at < pcd.size(); at += 12) {
    Eigen::Vector3f p;
    std::memcpy(p.data(), pcd.data() + at, 12);
    const double range_m = (p.cast<double>() - Eigen::Vector3d(100.0, 0.0, 0.0)).norm();
    ASSERT_NEAR(range_m, 10.0, 0.6);
  }
}

TEST_F(Save, SaysWhyItCannot) {
  UdpSocket client;
  const auto reason = [&](const Lilod& lilod) {
    const json error = ask(client, lilod, R"({"save":"trajectory"})", "error");
    return error["error"]["reason"].get<std::string>();
  };
  {
    Lilod lilod;
    ASSERT_TRUE(lilod.wait_ready());
    EXPECT_NE(reason(lilod).find("state.directory"), std::string::npos);
  }
  Lilod lilod("state:\n  directory: " + folder_ + "/not/there\n");
  ASSERT_TRUE(lilod.wait_ready());
  EXPECT_NE(reason(lilod).find("cannot write " + folder_ + "/not/there/trajectory.tum"),
            std::string::npos);
}

// Ten thousand requests to save write bounded files, one after the other.
TEST_F(Save, CannotFillTheDisk) {
  Lilod lilod("", {{"STATE_DIRECTORY", folder_}});
  ASSERT_TRUE(lilod.wait_ready());
  Sensor().turn(lilod, 3.0);
  UdpSocket client;
  for (int k = 0; k < 10'000; ++k)
    client.send_to(lilod.server_port(),
                   k % 2 == 0 ? R"({"save":"map"})" : R"({"save":"trajectory"})");
  EXPECT_TRUE(next_of_kind(client, "done"));
  EXPECT_EQ(lilod.stop(), 0) << lilod.process().standard_error();
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder_)) {
    ++files;
    EXPECT_LT(file.file_size(), 1'000'000U) << file.path();
  }
  EXPECT_LE(files, 2U);
}

}  // namespace
}  // namespace lilo
