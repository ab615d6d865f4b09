#include "apps/formats/mcap_writer.h"

#include <algorithm>
#include <cstring>

#include "apps/formats/bag_file.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

constexpr std::size_t kChunkBytes = 1U << 20U;

template <class T>
std::string raw(T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof bytes);
  return {bytes, sizeof bytes};
}
std::string u16(std::size_t v) { return raw(static_cast<std::uint16_t>(v)); }
std::string u32(std::size_t v) { return raw(static_cast<std::uint32_t>(v)); }
std::string u64(std::uint64_t v) { return raw(v); }
/// A text or a table behind the number of its bytes.
std::string sized(std::string_view s) { return u32(s.size()).append(s); }

std::string record(McapOp op, std::string_view body) {
  return std::string(1, static_cast<char>(op)).append(u64(body.size())).append(body);
}

}  // namespace

McapWriter::McapWriter(const std::string& file) : file_(file), out_(file, std::ios::binary) {
  if (!out_) throw StartupError(file + ": cannot be written", "choose another --out");
  put(kMcapMagic);
  put(record(kHeader, sized("ros2") + sized("jaywalk")));
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& type, const std::string& schema,
                                      const std::string& qos) {
  const auto number = static_cast<std::uint16_t>(topics_.size() + 1);
  topics_.push_back({topic, type});
  const std::string records = record(kSchema, u16(number) + sized(type) + sized("ros2msg") + sized(schema)) +
                              record(kChannel, u16(number) + u16(number) + sized(topic) + sized("cdr") +
                                                   sized(sized("offered_qos_profiles") + sized(qos)));
  definitions_ += records;
  chunk_ += records;
  return number;
}

void McapWriter::write(std::uint16_t channel, Time stamp, std::string_view message) {
  const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp.time_since_epoch().count(), 0));
  Topic& topic = topics_[channel - 1U];
  if (message_index_.empty()) chunk_first_ns_ = chunk_last_ns_ = ns;
  if (messages_ == 0) first_ns_ = last_ns_ = ns;
  chunk_first_ns_ = std::min(chunk_first_ns_, ns), chunk_last_ns_ = std::max(chunk_last_ns_, ns);
  first_ns_ = std::min(first_ns_, ns), last_ns_ = std::max(last_ns_, ns);
  message_index_[channel] += u64(ns) + u64(chunk_.size());
  chunk_ += record(kMessage, u16(channel) + u32(topic.messages) + u64(ns) + u64(ns) + std::string(message));
  ++topic.messages, ++messages_;
  if (chunk_.size() >= kChunkBytes) put_chunk();
}

void McapWriter::put(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  offset_ += bytes.size();
}

void McapWriter::put_chunk() {
  if (chunk_.empty()) return;
  const std::string packed = packed_zstd(chunk_);
  const std::string chunk = record(kChunk, u64(chunk_first_ns_) + u64(chunk_last_ns_) + u64(chunk_.size()) +
                                               u32(crc_of(chunk_)) + sized("zstd") + u64(packed.size()) + packed);
  ChunkIndex index{chunk_first_ns_, chunk_last_ns_, offset_, chunk.size(), 0, packed.size(), chunk_.size(), {}};
  put(chunk);
  const std::uint64_t behind = offset_;
  for (const auto& [channel, entries] : message_index_) {
    index.index_offsets[channel] = offset_;
    put(record(kMessageIndex, u16(channel) + sized(entries)));
  }
  index.index_length = offset_ - behind;
  chunks_.push_back(index);
  chunk_.clear();
  message_index_.clear();
}

std::string McapWriter::index_record(const ChunkIndex& chunk) const {
  std::string offsets;
  for (const auto& [channel, offset] : chunk.index_offsets) offsets += u16(channel) + u64(offset);
  return record(kChunkIndex, u64(chunk.first_ns) + u64(chunk.last_ns) + u64(chunk.offset) + u64(chunk.length) +
                                 sized(offsets) + u64(chunk.index_length) + sized("zstd") + u64(chunk.packed_size) +
                                 u64(chunk.size));
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t k = 0; k < topics_.size(); ++k) counts += u16(k + 1) + u64(topics_[k].messages);
  return record(kStatistics, u64(messages_) + u16(topics_.size()) + u32(topics_.size()) + u32(attachments_) + u32(0) +
                                 u32(chunks_.size()) + u64(first_ns()) + u64(last_ns_) + sized(counts));
}

void McapWriter::attach(const std::filesystem::path& file) {
  put_chunk();
  std::ifstream in(file, std::ios::binary);
  const std::uint64_t bytes = std::filesystem::file_size(file);
  const std::string name = sized(file.filename().string()), type = sized("application/octet-stream");
  const std::string head = u64(0) + u64(0) + name + type + u64(bytes);
  const std::uint64_t at = offset_, length = head.size() + bytes + sizeof(std::uint32_t);
  put(std::string(1, static_cast<char>(kAttachment)) + u64(length) + head);
  std::uint32_t crc = crc_of(head);
  std::string block(kChunkBytes, '\0');
  for (std::uint64_t left = bytes; left > 0;) {
    const auto next = static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size()));
    if (!in.read(block.data(), static_cast<std::streamsize>(next)))
      throw StartupError(file.string() + ": cannot be read", "check its permissions");
    crc = crc_of(std::string_view(block).substr(0, next), crc);
    put(std::string_view(block).substr(0, next));
    left -= next;
  }
  put(u32(crc));
  attachment_indexes_ +=
      record(kAttachmentIndex, u64(at) + u64(9 + length) + u64(0) + u64(0) + u64(bytes) + name + type);
  ++attachments_;
}

void McapWriter::close() {
  put_chunk();
  put(record(kDataEnd, u32(0)));  // no CRC of the whole: each chunk has its own
  std::string indexes;
  for (const ChunkIndex& chunk : chunks_) indexes += index_record(chunk);
  const std::uint64_t start = offset_;
  std::string summary = definitions_ + indexes + attachment_indexes_ + statistics();
  const std::uint64_t offsets = start + summary.size();
  const auto group = [&](McapOp op, std::uint64_t before, const std::string& records) {
    if (records.empty()) return;
    summary +=
        record(kSummaryOffset, std::string(1, static_cast<char>(op)) + u64(start + before) + u64(records.size()));
  };
  group(kChunkIndex, definitions_.size(), indexes);
  group(kAttachmentIndex, definitions_.size() + indexes.size(), attachment_indexes_);
  const std::string footer = std::string(1, static_cast<char>(kFooter)) + u64(20) + u64(start) + u64(offsets);
  put(summary);
  put(footer + u32(crc_of(summary + footer)));
  put(kMcapMagic);
  if (!out_.flush()) throw StartupError(file_ + ": the disk did not take all of it", "free some space and run again");
}

}  // namespace jaywalk::exchange
