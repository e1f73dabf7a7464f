// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/mcap_reader.hpp"

#include "tests/daemon/child_process.hpp"
#include "tests/daemon/text_of.hpp"
#include "tests/tools/mcap_core.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/record/mcap_bytes.hpp"
#include "tools/record/mcap_writer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lilo::mcap {
namespace {

using Messages = std::vector<std::pair<std::string, std::string>>;  // topic and text

/// What a file holds, and why it could not be read further.
struct Read {
  Messages messages;
  std::string error;
};

Read read(const std::string& file) {
  Read out;
  try {
    Reader reader(file);
    for (Message m; reader.next(m);) {
      out.messages.emplace_back(m.topic, m.data);
      EXPECT_LE(reader.progress(), 1.0);
    }
  } catch (const std::runtime_error& error) {
    out.error = error.what();
  }
  return out;
}

class McapReader : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return folder_.path() + "/" + name; }
  [[nodiscard]] std::string file_of(const std::string& bytes) const {
    std::ofstream(path("made.mcap"), std::ios::binary) << bytes;
    return path("made.mcap");
  }

 private:
  TemporaryFolder folder_;
};

const std::string kMagic("\x89MCAP0\r\n", 8);

Bytes channel(std::uint16_t id, std::string_view topic) {
  Bytes out;
  out.u16(id);
  out.u16(0);
  out.string(topic);
  out.string("json");
  out.strings({});
  return out;
}

Bytes message(std::uint16_t id, std::string_view text) {
  Bytes out;
  out.u16(id);
  out.u32(0);
  out.u64(0);
  out.u64(0);
  out.raw(text);
  return out;
}

Bytes chunk(const Bytes& records, std::string_view compression = "") {
  Bytes out;
  out.u64(0);
  out.u64(0);
  out.u64(records.size());
  out.u32(0);
  out.string(compression);
  out.u64(records.size());
  out.raw(records.text());
  return out;
}

// Five seconds, so five chunks.
TEST_F(McapReader, FindsWhatTheWriterWrote) {
  Writer writer(path("a.mcap"));
  const std::uint16_t schema = writer.add_schema("any", "{}");
  const std::uint16_t pose = writer.add_channel("/pose", schema);
  const std::uint16_t health = writer.add_channel("/health", schema);
  Messages expected;
  for (std::uint32_t k = 0; k < 50; ++k) {
    const std::uint16_t on = k % 10 == 0 ? health : pose;
    expected.emplace_back(on == health ? "/health" : "/pose", std::to_string(k));
    writer.write(on, k, k * 100'000'000LL, 0, expected.back().second);
  }
  writer.finish();
  const Read found = read(path("a.mcap"));
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.messages, expected);
}

// The library that Foxglove itself uses.
TEST_F(McapReader, FindsWhatMcapCoreWrote) {
  if (!has_mcap_core()) GTEST_SKIP() << without_mcap_core();
  const std::string program = LILO_TOOLS_TESTS_DIR "/write_mcap.mjs";
  for (const char* how : {"chunks", "no_chunks"}) {
    const Finished run =
        run_to_end({"/usr/bin/env", "node", program, node_modules(), how, path("b.mcap")});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    const Read found = read(path("b.mcap"));
    EXPECT_EQ(found.error, "") << how;
    EXPECT_EQ(found.messages, (Messages{{"/a", "1"}, {"/b", "2"}, {"/a", "3"}})) << how;
  }
}

// At whatever byte it ends, what came before is read, and the error says where.
TEST_F(McapReader, SaysWhereAFileEndsEarly) {
  Bytes bytes;
  bytes.raw(kMagic);
  Bytes records;
  records.record(0x04, channel(3, "/a"));
  records.record(0x05, message(3, "first"));
  bytes.record(0x06, chunk(records));
  const std::size_t chunk_end = bytes.size();
  bytes.record(0x05, message(3, "second"));
  const std::string whole = bytes.text();
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const Read found = read(file_of(whole.substr(0, size)));
    const bool is_mcap = size >= kMagic.size();
    EXPECT_NE(found.error.find(is_mcap ? "ends early" : "no MCAP file"), std::string::npos)
        << size << ": " << found.error;
    EXPECT_EQ(found.messages.size(), size == whole.size() ? 2U
                                     : size >= chunk_end  ? 1U
                                                          : 0U)
        << size;
  }
}

/// A file of one record, and what its error says.
struct Damage {
  Bytes records;
  const char* error;
};

TEST_F(McapReader, NamesWhatIsDamaged) {
  Bytes far_message;  // longer than its file
  far_message.u8(0x05);
  far_message.u64(~std::uint64_t{0});
  Bytes torn, torn_chunk, nested, nested_chunk, compressed, unknown, short_channel, short_message;
  torn.raw(std::string(5, '\x05'));
  torn_chunk.record(0x06, chunk(torn));
  nested.record(0x06, chunk(Bytes{}));
  nested_chunk.record(0x06, chunk(nested));
  compressed.record(0x06, chunk(torn, "zstd"));
  unknown.record(0x05, message(7, "x"));
  short_channel.record(0x04, Bytes{});
  short_message.record(0x05, Bytes{});
  for (const auto& [records, error] : std::vector<Damage>{
           {far_message, "byte 17: ends early"},
           {torn_chunk, "a record goes beyond its chunk"},
           {nested_chunk, "a chunk within a chunk"},
           {compressed, "compressed by zstd"},
           {unknown, "a message of channel 7"},
           {short_channel, "a damaged channel"},
           {short_message, "a damaged message"},
       }) {
    const std::string file = file_of(kMagic + records.text());
    const Read found = read(file);
    EXPECT_NE(found.error.find(error), std::string::npos) << error << ": " << found.error;
    EXPECT_EQ(found.error.rfind(file + ": byte ", 0), 0U) << found.error;
  }
}

TEST_F(McapReader, RefusesWhatIsNoFile) {
  EXPECT_NE(read("/nonexistent/a.mcap").error.find("/nonexistent/a.mcap: "), std::string::npos);
  EXPECT_NE(read("/").error, "");
  EXPECT_NE(read(file_of("PK\x03\x04 and more")).error.find("no MCAP file"), std::string::npos);
}

}  // namespace
}  // namespace lilo::mcap
