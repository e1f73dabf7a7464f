// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

namespace lilo::mcap {

/// A message; what it names lives until the next one is read.
struct Message {
  std::string_view topic, data;
};

/// Reads the messages of an MCAP file (mcap.dev/spec, version 0) in the order they were written,
/// with or without chunks. A chunk may not be compressed. All throw std::runtime_error that names
/// the file and the byte: where the file cannot be read, is not MCAP, is damaged or ends early.
class Reader {
 public:
  explicit Reader(std::string path);

  /// False after the last one.
  bool next(Message& message);
  /// Part of the file that was read, in [0, 1].
  [[nodiscard]] double progress() const;

 private:
  /// A record that lies in the file or in a chunk.
  struct Record {
    std::uint8_t opcode = 0;
    std::string_view content;
  };

  bool next_in_chunk(Record& record);
  bool next_in_file(Record& record);
  void read(std::string& into, std::uint64_t bytes);
  void open_chunk(std::string_view content);
  void add_channel(std::string_view content);
  [[nodiscard]] Message to_message(std::string_view content) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  std::ifstream file_;
  std::uint64_t at_ = 0, size_ = 0;  // bytes
  std::string head_, content_;       // of the record in the file that is being read
  std::string_view chunk_;           // what is left of content_ when that is a chunk
  std::map<std::uint16_t, std::string> topics_;
};

}  // namespace lilo::mcap
