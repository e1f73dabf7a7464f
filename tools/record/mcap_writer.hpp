// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/record/mcap_bytes.hpp"

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lilo::mcap {

/// Writes an MCAP file (mcap.dev/spec, version 0): uncompressed chunks with their message indexes,
/// and a summary, so that readers jump to any time. A chunk is written when it has 256 KiB or
/// holds a second, so a program that dies loses no more; `mcap recover` adds the missing end.
/// All throw std::runtime_error when the file cannot be written.
class Writer {
 public:
  explicit Writer(std::string path);

  /// `json_schema`: JSON Schema as text. Schemas count from 1.
  std::uint16_t add_schema(const std::string& name, const std::string& json_schema);
  /// A topic of JSON messages. Channels count from 0.
  std::uint16_t add_channel(const std::string& topic, std::uint16_t schema);
  /// Times are UTC: when it was recorded, when it was published.
  void write(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_ns,
             std::int64_t publish_ns, std::string_view message);
  /// Everything that is still missing, and the end. Nothing may follow.
  void finish();

 private:
  struct TimeSpan {
    std::uint64_t first = 0, last = 0;
    bool empty = true;
    void add(std::uint64_t time);
  };
  using Index = std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>>;

  void put(const Bytes& bytes);
  void end_chunk();
  std::map<std::uint16_t, std::uint64_t> write_message_indexes();
  void index_chunk(std::uint64_t chunk_start, std::uint64_t indexes_start,
                   const std::map<std::uint16_t, std::uint64_t>& index_of_channel,
                   std::uint64_t chunk_bytes);
  [[nodiscard]] Bytes statistics() const;
  void write_summary();

  std::string path_;
  std::ofstream file_;
  std::uint64_t at_ = 0;  // bytes in the file
  std::uint16_t schemas_ = 0, channels_ = 0;
  std::uint32_t chunks_ = 0;
  std::map<std::uint16_t, std::uint64_t> messages_;  // of every channel
  TimeSpan file_span_, chunk_span_;
  Bytes chunk_;  // the records of the chunk that is being filled
  Index index_;  // of its messages: time and place in it
  Bytes schema_records_, channel_records_, chunk_index_records_;  // for the summary
};

}  // namespace lilo::mcap
