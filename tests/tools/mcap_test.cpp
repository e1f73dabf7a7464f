// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/child_process.hpp"
#include "tests/tools/mcap_core.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/record/mcap_schemas.hpp"
#include "tools/record/recording.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace lilo {
namespace {

using nlohmann::json;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

std::string pose(int seq, const char* status = "tracking", const char* session = "a") {
  return fmt::format(
      R"({{"v":"2.0","timestamp":1.5,"session":"{}","seq":{},"pose":{{"stamp":{{"sec":1,"nsec":500000000}},)"
      R"("frame_id":"odom","child_frame_id":"velodyne","status":"{}","position":{{"x":{},"y":2,"z":3}},)"
      R"("orientation":{{"x":0,"y":0,"z":0,"w":1}},"latency_ms":3.1,"lost_packets":0}}}})",
      session, seq, status, seq);
}

const std::string kHealth =
    R"({"v":"2.0","timestamp":2.5,"session":"a","health":{"status":"tracking","complaints":[]}})";

/// What @mcap/core makes of a file.
json read_by_mcap_core(const std::string& file) {
  const std::string program = LILO_TOOLS_TESTS_DIR "/read_mcap.mjs";
  const Finished run = run_to_end({"/usr/bin/env", "node", program, node_modules(), file});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  return json::parse(run.output, nullptr, false);
}

class Mcap : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_mcap_core()) GTEST_SKIP() << without_mcap_core();
  }
  [[nodiscard]] std::string path(const char* name) const { return folder_.path() + "/" + name; }

 private:
  TemporaryFolder folder_;
};

// 1000 poses over 100 s: a chunk a second, every message by its index and its checksum.
TEST_F(Mcap, IndexedAndStreamedReadersFindEverything) {
  Recording recording(path("a.mcap"));
  constexpr int kPoses = 1000;
  for (int k = 0; k < kPoses; ++k) {
    const std::int64_t now_ns = kStart_ns + k * 100'000'000LL;
    recording.take(pose(k), now_ns);
    if (k % 10 == 0) recording.take(kHealth, now_ns);
  }
  recording.finish();
  const json file = read_by_mcap_core(path("a.mcap"));
  EXPECT_EQ(file["topics"]["/lilod/pose"]["count"], kPoses);
  EXPECT_EQ(file["topics"]["/lilod/health"]["count"], 100);
  EXPECT_EQ(file["topics"]["/odom"]["count"], kPoses);
  EXPECT_EQ(file["topics"]["/tf"]["count"], kPoses);
  EXPECT_GE(file["chunks"], 90);
  EXPECT_EQ(file["messages"].size(), 3U * kPoses + 100U);
  EXPECT_EQ(file["streamed"], 3 * kPoses + 100);
  EXPECT_EQ(file["whole"], true);
  EXPECT_GE(file["late"], (3 * kPoses + 100) / 2);
}

// What came is what is read back, byte by byte and with its times.
TEST_F(Mcap, DatagramsComeBackAsTheyWere) {
  Recording recording(path("b.mcap"));
  recording.take(pose(7), kStart_ns);
  recording.take(kHealth, kStart_ns + 1);
  recording.finish();
  const json file = read_by_mcap_core(path("b.mcap"));
  const json& messages = file["messages"];
  const auto on = [&](const char* topic) {
    return *std::find_if(messages.begin(), messages.end(),
                         [&](const json& m) { return m["topic"] == topic; });
  };
  EXPECT_EQ(on("/lilod/pose")["text"], pose(7));
  EXPECT_EQ(on("/lilod/pose")["sequence"], 7);
  EXPECT_EQ(on("/lilod/pose")["logTime"], std::to_string(kStart_ns));
  EXPECT_EQ(on("/lilod/pose")["publishTime"], "1500000000");
  EXPECT_EQ(on("/lilod/health")["text"], kHealth);
  EXPECT_EQ(on("/lilod/health")["publishTime"], "2500000000");
  const json odom = json::parse(on("/odom")["text"].get<std::string>());
  EXPECT_EQ(odom["pose"]["position"]["x"], 7);
  EXPECT_EQ(odom["timestamp"]["nsec"], 500'000'000);
  const json transform = json::parse(on("/tf")["text"].get<std::string>());
  EXPECT_EQ(transform["child_frame_id"], "velodyne");
  EXPECT_EQ(transform["rotation"]["w"], 1);
}

TEST_F(Mcap, GuessesAreNotShownAsPoses) {
  Recording recording(path("c.mcap"));
  recording.take(pose(0, "initializing"), kStart_ns);
  recording.take(pose(1, "lost"), kStart_ns + 1);
  recording.take(pose(2, "degraded"), kStart_ns + 2);
  recording.finish();
  const json file = read_by_mcap_core(path("c.mcap"));
  EXPECT_EQ(file["topics"]["/lilod/pose"]["count"], 3);
  EXPECT_EQ(file["topics"]["/odom"]["count"], 1);
  EXPECT_EQ(file["topics"]["/tf"]["count"], 1);
}

TEST_F(Mcap, AFileWithoutMessagesIsWhole) {
  Recording recording(path("d.mcap"));
  recording.finish();
  const json file = read_by_mcap_core(path("d.mcap"));
  EXPECT_EQ(file["messages"].size(), 0U);
  EXPECT_EQ(file["whole"], true);
}

TEST_F(Mcap, SchemasAreInside) {
  Recording recording(path("e.mcap"));
  recording.finish();
  const json topics = read_by_mcap_core(path("e.mcap"))["topics"];
  for (const auto& [topic, schema] :
       std::map<std::string, std::string>{{"/lilod/pose", "lilod.Pose"},
                                          {"/lilod/health", "lilod.Health"},
                                          {"/odom", "foxglove.PoseInFrame"},
                                          {"/tf", "foxglove.FrameTransform"}}) {
    EXPECT_EQ(topics[topic]["schema"], schema);
    EXPECT_EQ(topics[topic]["schemaEncoding"], "jsonschema");
    EXPECT_EQ(topics[topic]["encoding"], "json");
    EXPECT_EQ(topics[topic]["schemaText"]["type"], "object");
  }
}

TEST(McapSchemas, HaveNoReferences) {
  for (const char* kind : {"pose", "health"}) {
    const std::string text = datagram_schema(kind);
    EXPECT_EQ(text.find("$ref"), std::string::npos);
    const json schema = json::parse(text);
    EXPECT_TRUE(schema["properties"].contains(kind));
    EXPECT_FALSE(schema["properties"].contains("hello"));
  }
  const json pose_schema = json::parse(datagram_schema("pose"));
  EXPECT_EQ(pose_schema["properties"]["pose"]["properties"]["position"]["properties"]["x"]["type"],
            "number");
}

TEST(Recording, CountsWhatIsMissing) {
  const TemporaryFolder folder;
  Recording recording(folder.path() + "/a.jsonl");
  for (const int seq : {0, 1, 4}) recording.take(pose(seq), kStart_ns);
  recording.take(pose(0, "tracking", "b"), kStart_ns);
  recording.take(pose(1, "tracking", "b"), kStart_ns);
  recording.take(kHealth, kStart_ns);
  recording.take("no JSON", kStart_ns);
  recording.finish();
  EXPECT_EQ(to_text(recording.counts()), "5 poses, 1 health reports, 2 missed, 2 sessions");
}

// A new session has a new origin: its poses never go into the same trajectory.
TEST(Recording, TumHasAFileASession) {
  const TemporaryFolder folder;
  Recording recording(folder.path() + "/a.tum");
  recording.take(pose(0), kStart_ns);
  recording.take(pose(1), kStart_ns);
  recording.take(pose(0, "tracking", "b"), kStart_ns);
  recording.finish();
  EXPECT_EQ(std::filesystem::file_size(folder.path() + "/a.tum"),
            2 * std::filesystem::file_size(folder.path() + "/a_2.tum"));
}

TEST(Recording, TumReplacesNoOtherFile) {
  const TemporaryFolder folder;
  folder.write("a_2.tum", "precious");
  Recording recording(folder.path() + "/a.tum");
  recording.take(pose(0), kStart_ns);
  recording.take(pose(0, "tracking", "b"), kStart_ns);
  recording.finish();
  EXPECT_EQ(std::filesystem::file_size(folder.path() + "/a_2.tum"), std::string("precious").size());
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/a_3.tum"));
}

TEST(Recording, RefusesEndingsItDoesNotKnow) {
  EXPECT_THROW(Recording("/tmp/poses.csv"), std::runtime_error);
  EXPECT_THROW(Recording("/nonexistent/poses.mcap"), std::runtime_error);
}

}  // namespace
}  // namespace lilo
