// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/mcap_writer.hpp"

#include "tools/text_file.hpp"

#include <boost/crc.hpp>

#include <algorithm>

namespace lilo::mcap {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::size_t kChunkBytes = 256 << 10;
constexpr std::uint64_t kChunkSpan_ns = 1'000'000'000;

// mcap.dev/spec, "Records".
enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F
};

std::uint32_t crc32(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace

void Writer::TimeSpan::add(std::uint64_t time) {
  first = empty ? time : std::min(first, time);
  last = empty ? time : std::max(last, time);
  empty = false;
}

Writer::Writer(std::string path)
    : path_(std::move(path)), file_(path_, std::ios::binary | std::ios::trunc) {
  Bytes header, start;
  header.string("");  // profile: none
  header.string("lilo " LILO_VERSION);
  start.raw(kMagic);
  start.record(kHeader, header);
  put(start);
  finish_text(file_, path_);  // a file that cannot be written is known at once
}

void Writer::put(const Bytes& bytes) {
  file_.write(bytes.text().data(), static_cast<std::streamsize>(bytes.size()));
  at_ += bytes.size();
}

std::uint16_t Writer::add_schema(const std::string& name, const std::string& json_schema) {
  Bytes schema;
  schema.u16(++schemas_);  // 0 means none
  schema.string(name);
  schema.string("jsonschema");
  schema.string(json_schema);
  chunk_.record(kSchema, schema);
  schema_records_.record(kSchema, schema);
  return schemas_;
}

std::uint16_t Writer::add_channel(const std::string& topic, std::uint16_t schema) {
  Bytes channel;
  channel.u16(channels_);
  channel.u16(schema);
  channel.string(topic);
  channel.string("json");
  channel.strings({});
  chunk_.record(kChannel, channel);
  channel_records_.record(kChannel, channel);
  messages_[channels_] = 0;
  return channels_++;
}

void Writer::write(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_ns,
                   std::int64_t publish_ns, std::string_view message) {
  const auto time = static_cast<std::uint64_t>(log_ns);
  Bytes record;
  record.u16(channel);
  record.u32(sequence);
  record.u64(time);
  record.u64(static_cast<std::uint64_t>(publish_ns));
  record.raw(message);
  index_[channel].emplace_back(time, chunk_.size());
  chunk_.record(kMessage, record);
  chunk_span_.add(time);
  file_span_.add(time);
  ++messages_[channel];
  const bool full = chunk_.size() >= kChunkBytes;
  if (full || chunk_span_.last - chunk_span_.first >= kChunkSpan_ns) end_chunk();
}

void Writer::end_chunk() {
  if (chunk_.size() == 0) return;
  Bytes chunk, record;
  chunk.u64(chunk_span_.first);
  chunk.u64(chunk_span_.last);
  chunk.u64(chunk_.size());
  chunk.u32(crc32(chunk_.text()));
  chunk.string("");  // compression: none
  chunk.u64(chunk_.size());
  chunk.raw(chunk_.text());
  record.record(kChunk, chunk);
  const std::uint64_t chunk_start = at_;
  put(record);
  const std::uint64_t indexes_start = at_;
  const auto index_of_channel = write_message_indexes();
  index_chunk(chunk_start, indexes_start, index_of_channel, chunk_.size());
  finish_text(file_, path_);
  ++chunks_;
  chunk_.clear();
  index_.clear();
  chunk_span_ = {};
}

/// Where each of them is.
std::map<std::uint16_t, std::uint64_t> Writer::write_message_indexes() {
  std::map<std::uint16_t, std::uint64_t> places;
  for (const auto& [channel, entries] : index_) {
    Bytes inner, index, record;
    for (const auto& [time, offset] : entries) {
      inner.u64(time);
      inner.u64(offset);
    }
    index.u16(channel);
    index.string(inner.text());
    record.record(kMessageIndex, index);
    places[channel] = at_;
    put(record);
  }
  return places;
}

void Writer::index_chunk(std::uint64_t chunk_start, std::uint64_t indexes_start,
                         const std::map<std::uint16_t, std::uint64_t>& index_of_channel,
                         std::uint64_t chunk_bytes) {
  Bytes places, index;
  for (const auto& [channel, place] : index_of_channel) {
    places.u16(channel);
    places.u64(place);
  }
  index.u64(chunk_span_.first);
  index.u64(chunk_span_.last);
  index.u64(chunk_start);
  index.u64(indexes_start - chunk_start);
  index.string(places.text());
  index.u64(at_ - indexes_start);
  index.string("");        // compression: none,
  index.u64(chunk_bytes);  // so compressed
  index.u64(chunk_bytes);  // and uncompressed size agree
  chunk_index_records_.record(kChunkIndex, index);
}

Bytes Writer::statistics() const {
  Bytes counts, statistics, record;
  std::uint64_t all = 0;
  for (const auto& [channel, count] : messages_) {
    counts.u16(channel);
    counts.u64(count);
    all += count;
  }
  statistics.u64(all);
  statistics.u16(schemas_);
  statistics.u32(channels_);
  statistics.u32(0);  // attachments
  statistics.u32(0);  // metadata
  statistics.u32(chunks_);
  statistics.u64(file_span_.first);
  statistics.u64(file_span_.last);
  statistics.string(counts.text());
  record.record(kStatistics, statistics);
  return record;
}

void Writer::finish() {
  end_chunk();
  Bytes end, record;
  end.u32(0);  // no checksum over all data: chunks have their own
  record.record(kDataEnd, end);
  put(record);
  write_summary();
  finish_text(file_, path_);
}

void Writer::write_summary() {
  const std::uint64_t summary_start = at_;
  const Bytes statistics_record = statistics();
  Bytes summary, offsets;
  const auto add_group = [&](Opcode opcode, const Bytes& group) {
    if (group.size() == 0) return;
    Bytes offset;
    offset.u8(opcode);
    offset.u64(summary_start + summary.size());
    offset.u64(group.size());
    offsets.record(kSummaryOffset, offset);
    summary.raw(group.text());
  };
  add_group(kSchema, schema_records_);
  add_group(kChannel, channel_records_);
  add_group(kStatistics, statistics_record);
  add_group(kChunkIndex, chunk_index_records_);
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary.raw(offsets.text());
  constexpr std::uint64_t kFooterBytes = 8 + 8 + 4;
  summary.u8(kFooter);
  summary.u64(kFooterBytes);
  summary.u64(summary_start);
  summary.u64(offsets_start);
  summary.u32(crc32(summary.text()));  // over all from summary_start to here
  summary.raw(kMagic);
  put(summary);
}

}  // namespace lilo::mcap
