// ROS 1's bags, format 2.0 (wiki.ros.org/Bags/Format/2.0): records of header fields and bytes. The format has no check
// sums but those of what it is packed with.
#include <map>
#include <string>

#include "apps/formats/bag_file.h"
#include "apps/formats/byte_file.h"
#include "apps/formats/little_endian.h"
#include "apps/formats/unpacking.h"
#include "hal/shown_text.h"

namespace jaywalk::exchange {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr const char* kRemedy = "take an undamaged copy of it, or what 'rosbag reindex' makes of this one";

enum Op : std::uint8_t { kMessageData = 2, kBagHeader = 3, kChunk = 5, kConnection = 7 };

/// "name=value" fields, each behind its length; empty where they are none.
std::map<std::string, std::string, std::less<>> fields_of(std::string_view bytes, bool& ok) {
  std::map<std::string, std::string, std::less<>> fields;
  LittleEndian in(bytes);
  while (!in.empty() && in.ok()) {
    const std::string_view field = in.sized();
    const std::size_t equals = field.find('=');
    ok = ok && in.ok() && equals != std::string_view::npos;
    if (ok) fields.emplace(field.substr(0, equals), field.substr(equals + 1));
  }
  ok = ok && in.ok();
  return fields;
}

class Ros1Bag {
 public:
  Ros1Bag(const std::filesystem::path& path, const BagSink& sink) : file_(path, kRemedy), sink_(sink) {
    if (file_.read(0, kMagic.size()) != kMagic) file_.refuse(0, "no ROS 1 bag of format 2.0");
  }

  void read() {
    for (at_ = kMagic.size(); at_ < file_.size();) {
      const std::string head = sized_at(at_), body = sized_at(at_ + 4 + head.size());
      take(head, body, true);
      at_ += 8 + head.size() + body.size();
    }
    if (!headed_) refuse("there is no bag header");
    if (chunks_ != chunks_said_) {
      refuse("the file is cut short: " + std::to_string(chunks_) + " of " + std::to_string(chunks_said_) + " chunks");
    }
  }

 private:
  struct Connection {
    std::string topic, type;
  };
  using Fields = std::map<std::string, std::string, std::less<>>;

  std::string sized_at(std::uint64_t at) {
    const std::string size = file_.read(at, 4);
    return file_.read(at + 4, LittleEndian(size).u32());
  }
  template <class T>
  [[nodiscard]] T number(const Fields& fields, std::string_view name) const {
    const auto found = fields.find(name);
    if (found == fields.end() || found->second.size() != sizeof(T))
      refuse("a record without '" + std::string(name) + "'");
    return LittleEndian(found->second).number<T>();
  }
  void take(std::string_view head, std::string_view body, bool outside) {
    bool ok = true;
    const Fields fields = fields_of(head, ok);
    if (!ok) refuse("a record whose header is damaged");
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
    if (!can_unpack(method)) refuse("a chunk packed with '" + shown(method) + "', which is not known here");
    const auto bytes = number<std::uint32_t>(fields, "size");
    if (bytes > kMostRecordBytes) refuse("a chunk of " + std::to_string(bytes) + " bytes");
    const auto unpacked = unpack(method, body, bytes);
    if (!unpacked) refuse("a chunk that does not unpack");
    LittleEndian records(*unpacked);
    while (!records.empty()) {
      const std::string_view head = records.sized(), inner = records.sized();
      if (!records.ok()) refuse("a chunk with something else than records in it");
      take(head, inner, false);
    }
  }
  void connect(const Fields& fields, std::string_view body) {
    bool ok = true;
    const Fields said = fields_of(body, ok);
    const auto topic = fields.find("topic"), type = said.find("type");
    if (!ok || topic == fields.end() || type == said.end()) refuse("a connection without topic or type");
    connections_[number<std::uint32_t>(fields, "conn")] = {topic->second, type->second};
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
