// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/mcap_reader.hpp"

#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lilo::mcap {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::uint8_t kChannel = 0x04, kMessage = 0x05, kChunk = 0x06, kDataEnd = 0x0f;
constexpr std::size_t kHeadBytes = 9;  // opcode and length

/// Takes values off the front of a record; none once it has been too short for one.
class Fields {
 public:
  explicit Fields(std::string_view text) : text_(text) {}

  std::optional<std::uint64_t> integer(std::size_t bytes) {
    const auto text = raw(bytes);
    if (!text) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < bytes; ++k)
      value |= std::uint64_t{static_cast<unsigned char>((*text)[k])} << (8 * k);
    return value;
  }
  std::optional<std::string_view> raw(std::uint64_t bytes) {
    if (bytes > text_.size()) {
      text_ = {};
      return std::nullopt;
    }
    const std::string_view found = text_.substr(0, bytes);
    text_.remove_prefix(bytes);
    return found;
  }
  std::optional<std::string_view> string() {
    const auto bytes = integer(4);
    return bytes ? raw(*bytes) : std::nullopt;
  }
  [[nodiscard]] std::string_view rest() const { return text_; }

 private:
  std::string_view text_;
};

}  // namespace

Reader::Reader(std::string path) : path_(std::move(path)), file_(open_text(path_)) {
  std::error_code error;
  size_ = std::filesystem::file_size(path_, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot read: {}", path_, error.message()));
  if (size_ < kMagic.size()) fail("no MCAP file");
  read(head_, kMagic.size());
  if (head_ != kMagic) fail("no MCAP file");
}

double Reader::progress() const {
  return static_cast<double>(at_ - chunk_.size()) / static_cast<double>(size_);
}

bool Reader::next(Message& message) {
  Record record;
  while (next_in_chunk(record) || next_in_file(record)) {
    if (record.opcode == kChannel) add_channel(record.content);
    if (record.opcode == kChunk) open_chunk(record.content);
    if (record.opcode == kDataEnd) return false;
    if (record.opcode == kMessage) {
      message = to_message(record.content);
      return true;
    }
  }
  return false;
}

bool Reader::next_in_chunk(Record& record) {
  if (chunk_.empty()) return false;
  Fields fields(chunk_);
  const auto opcode = fields.integer(1), bytes = fields.integer(8);
  const auto content = bytes ? fields.raw(*bytes) : std::nullopt;
  if (!content) fail("a record goes beyond its chunk");
  record = {static_cast<std::uint8_t>(*opcode), *content};
  if (record.opcode == kChunk) fail("a chunk within a chunk");
  chunk_ = fields.rest();
  return true;
}

bool Reader::next_in_file(Record& record) {
  if (at_ == size_) fail("ends early; mcap recover mends it");
  read(head_, kHeadBytes);
  Fields fields(head_);
  const auto opcode = fields.integer(1), bytes = fields.integer(8);
  read(content_, *bytes);
  record = {static_cast<std::uint8_t>(*opcode), content_};
  return true;
}

void Reader::read(std::string& into, std::uint64_t bytes) {
  if (bytes > size_ - at_) fail("ends early; mcap recover mends it");
  into.resize(bytes);
  if (!file_.read(into.data(), static_cast<std::streamsize>(bytes))) fail("cannot be read");
  at_ += bytes;
}

void Reader::open_chunk(std::string_view content) {
  Fields fields(content);
  fields.raw(8 + 8 + 8 + 4);  // times, size and checksum of what is uncompressed
  const auto compression = fields.string();
  const auto bytes = fields.integer(8);
  if (!compression || !bytes || *bytes != fields.rest().size()) fail("a damaged chunk");
  if (!compression->empty())
    fail(
        fmt::format("chunks compressed by {}, expected none; mcap decompress helps", *compression));
  chunk_ = fields.rest();
}

void Reader::add_channel(std::string_view content) {
  Fields fields(content);
  const auto id = fields.integer(2);
  fields.integer(2);  // its schema
  const auto topic = fields.string();
  if (!id || !topic) fail("a damaged channel");
  topics_[static_cast<std::uint16_t>(*id)] = *topic;
}

Message Reader::to_message(std::string_view content) const {
  Fields fields(content);
  const auto channel = fields.integer(2);
  if (!fields.raw(4 + 8 + 8)) fail("a damaged message");  // sequence and times
  const auto topic = topics_.find(static_cast<std::uint16_t>(*channel));
  if (topic == topics_.end()) fail(fmt::format("a message of channel {}, which is none", *channel));
  return {topic->second, fields.rest()};
}

void Reader::fail(const std::string& what) const {
  throw std::runtime_error(fmt::format("{}: byte {}: {}", path_, at_ - chunk_.size(), what));
}

}  // namespace lilo::mcap
