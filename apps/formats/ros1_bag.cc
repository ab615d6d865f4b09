// ROS 1's bags, format 2.0 (wiki.ros.org/Bags/Format/2.0): records of header fields and bytes. The format has no check
// sums but those of what it is packed with. Its index is not believed: recorders of 2010 wrote one of wrong lengths,
// and 'rosbag reindex' leaves bytes before it that are nothing.
#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "apps/formats/bag_file.h"
#include "apps/formats/wire_reader.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLongestHead = 1U << 16U;  // bytes of a record's fields: topics and callers have names
constexpr std::uint64_t kIndexEntry = 12;          // bytes: time and offset
constexpr std::uint64_t kSearched = 1U << 20U;     // bytes at a time
constexpr const char* kRosRemedy = "take an undamaged copy of it, or what 'rosbag reindex' makes of this one";

enum Op : std::uint8_t { kMessageData = 2, kBagHeader = 3, kIndexData = 4, kChunk = 5, kConnection = 7 };

using Fields = std::map<std::string, std::string, std::less<>>;

/// "name=value" fields, each behind its length; nothing where they are none.
std::optional<Fields> fields_of(std::string_view bytes) {
  Fields fields;
  WireReader in(bytes);
  while (!in.empty()) {
    const std::string_view field = in.sized();
    const std::size_t equals = field.find('=');
    if (!in.ok() || equals == std::string_view::npos) return std::nullopt;
    fields.emplace(field.substr(0, equals), field.substr(equals + 1));
  }
  return fields;
}

class Ros1Bag {
 public:
  Ros1Bag(const std::filesystem::path& path, const BagSink& sink) : file_(path, kRosRemedy), sink_(sink) {
    if (file_.size() >= kMagic.size() && file_.read(0, kMagic.size()) == kMagic) return;
    const std::string first = file_.read(0, std::min<std::uint64_t>(32, file_.size()));
    throw StartupError(
        file_.name() + ": '" + shown(first.substr(0, first.find('\n'))) + "', no ROS 1 bag of format 2.0",
        "write it anew with Python's rosbag, which reads the older formats");
  }

  void read() {
    for (at_ = kMagic.size(); at_ < file_.size();) {
      const std::optional<Record> record = record_at(at_);
      if (!record) {
        const std::uint64_t junk = at_;
        if (!find_record()) file_.refuse(junk, "the file ends before what begins here, or that is no record");
        continue;
      }
      if (record->op == kBagHeader || record->op == kChunk || record->op == kConnection || record->op == kMessageData)
        take(record->fields, file_.read(record->end - record->bytes, record->bytes), true);
      at_ = record->end;
    }
    if (!headed_) refuse("there is no bag header");
    if (chunks_ != chunks_said_)
      refuse("the file is cut short: " + std::to_string(chunks_) + " of " + std::to_string(chunks_said_) + " chunks");
  }

 private:
  struct Connection {
    std::string topic, type;
  };
  struct Record {
    std::uint64_t end = 0;
    std::uint64_t bytes = 0;  ///< of its body, which ends it
    std::uint8_t op = 0;
    Fields fields;
  };

  /// The record that begins there; nothing where none does, or the file ends before it.
  std::optional<Record> record_at(std::uint64_t at) {
    if (at + 4 > file_.size()) return std::nullopt;
    const std::uint64_t head_bytes = u32_at(at);
    if (head_bytes > kLongestHead || at + 8 + head_bytes > file_.size()) return std::nullopt;
    std::optional<Fields> fields = fields_of(file_.read(at + 4, head_bytes));
    if (!fields || (*fields)["op"].size() != 1) return std::nullopt;
    const auto op = static_cast<std::uint8_t>((*fields)["op"].front());
    Record record{0, u32_at(at + 4 + head_bytes), op, std::move(*fields)};
    const std::uint64_t body = at + 8 + head_bytes;
    if (record.op == kIndexData) record.bytes = bytes_of_index(record, body);
    record.end = body + record.bytes;
    return record.end <= file_.size() ? std::optional(record) : std::nullopt;
  }
  /// By its number of entries, unless only what it claims leads to a record: those of 2010 claim more than they have.
  std::uint64_t bytes_of_index(const Record& record, std::uint64_t body) {
    const auto count = record.fields.find("count");
    if (count == record.fields.end() || count->second.size() != sizeof(std::uint32_t)) return record.bytes;
    const std::uint64_t entries = WireReader(count->second).u32() * kIndexEntry;
    const auto record_follows = [&](std::uint64_t after) {
      return after == file_.size() || (after + 8 <= file_.size() && begins_record(file_.read(after, 8)));
    };
    const bool claim_holds = !record_follows(body + entries) && record_follows(body + record.bytes);
    return entries >= record.bytes || claim_holds ? record.bytes : entries;
  }
  /// A head's length, and that of its first field.
  static bool begins_record(std::string_view bytes) {
    WireReader in(bytes);
    const std::uint32_t head = in.u32(), field = in.u32();
    return in.ok() && head <= kLongestHead && field >= 2 && field + 4 <= head;
  }
  /// Moves on to the next record behind what is none; false where there is none.
  bool find_record() {
    while (++at_ + 8 <= file_.size()) {
      const std::string some = file_.read(at_, std::min(kSearched, file_.size() - at_));
      for (std::size_t k = 0; k + 8 <= some.size(); ++k) {
        if (begins_record(std::string_view(some).substr(k, 8)) && record_at(at_ + k)) {
          at_ += k;
          return true;
        }
      }
      at_ += some.size() - 8;
    }
    return false;
  }
  std::uint32_t u32_at(std::uint64_t at) {
    const std::string size = file_.read(at, 4);
    return WireReader(size).u32();
  }
  template <class T>
  [[nodiscard]] T number(const Fields& fields, std::string_view name) const {
    const auto found = fields.find(name);
    if (found == fields.end() || found->second.size() != sizeof(T))
      refuse("a record without '" + std::string(name) + "'");
    return WireReader(found->second).number<T>();
  }
  void take(const Fields& fields, std::string_view body, bool outside) {
    const auto op = number<std::uint8_t>(fields, "op");
    if (op == kBagHeader && outside) read_header(fields);
    if (op == kChunk && outside) open_chunk(fields, body);
    if (op == kConnection) connect(fields, body);
    if (op == kMessageData) pass_on(fields, body);
  }
  void read_header(const Fields& fields) {
    headed_ = true;
    chunks_said_ = number<std::uint32_t>(fields, "chunk_count");
    const auto index = number<std::uint64_t>(fields, "index_pos");
    if (index == 0) refuse("the bag was never closed");
    if (index > file_.size()) refuse("the file is cut short: its index would begin at byte " + std::to_string(index));
  }
  void open_chunk(const Fields& fields, std::string_view body) {
    ++chunks_;
    const auto found = fields.find("compression");
    const std::string method = found == fields.end() ? "none" : found->second;
    const std::string unpacked = file_.unpacked(at_, method, body, number<std::uint32_t>(fields, "size"));
    WireReader records(unpacked);
    while (!records.empty()) {
      const std::string_view head = records.sized(), inner = records.sized();
      const std::optional<Fields> inside = fields_of(head);
      if (!records.ok() || !inside) refuse("a chunk with something else than records in it");
      take(*inside, inner, false);
    }
  }
  void connect(const Fields& fields, std::string_view body) {
    const std::optional<Fields> said = fields_of(body);
    const auto topic = fields.find("topic");
    if (!said || topic == fields.end() || !said->contains("type")) refuse("a connection without topic or type");
    connections_[number<std::uint32_t>(fields, "conn")] = {topic->second, said->at("type")};
  }
  void pass_on(const Fields& fields, std::string_view body) {
    const auto connection = connections_.find(number<std::uint32_t>(fields, "conn"));
    if (connection == connections_.end()) refuse("a message of a connection that the bag does not describe");
    const auto time = number<std::uint64_t>(fields, "time");  // s, and ns above them
    const Time logged{std::chrono::seconds(time & 0xFFFFFFFFU) + std::chrono::nanoseconds(time >> 32U)};
    sink_({connection->second.topic, connection->second.type, Wire::kRos1, logged, body});
  }
  [[noreturn]] void refuse(const std::string& cause) const { file_.refuse(at_, cause); }

  ByteFile file_;
  const BagSink& sink_;
  std::uint64_t at_ = 0;
  std::map<std::uint32_t, Connection> connections_;
  std::uint32_t chunks_ = 0, chunks_said_ = 0;
  bool headed_ = false;
};

}  // namespace

void read_ros1_bag(const std::filesystem::path& file, const BagSink& sink) { Ros1Bag(file, sink).read(); }

}  // namespace jaywalk::exchange
