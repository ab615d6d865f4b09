#include "tests/exchange/made_bags.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <cstring>
#include <map>

#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {
namespace {

constexpr std::int64_t kBillion = 1'000'000'000;

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}
std::string u16(std::size_t v) { return raw(static_cast<std::uint16_t>(v)); }
std::string u32(std::size_t v) { return raw(static_cast<std::uint32_t>(v)); }
std::string u64(std::size_t v) { return raw(static_cast<std::uint64_t>(v)); }
std::string sized(const std::string& s) { return u32(s.size()) + s; }

/// Fields of a message, in CDR or packed.
class Fields {
 public:
  explicit Fields(bool ros1) : ros1_(ros1) {}
  template <class T>
  Fields& put(T value) {
    while (!ros1_ && bytes_.size() % sizeof(T) != 0) bytes_ += '\0';
    bytes_ += raw(value);
    return *this;
  }
  Fields& text(const std::string& s) {
    put(static_cast<std::uint32_t>(ros1_ ? s.size() : s.size() + 1));
    bytes_ += s;
    if (!ros1_) bytes_ += '\0';
    return *this;
  }
  Fields& header(std::int64_t ns, const std::string& frame) {
    if (ros1_) put(std::uint32_t{7});
    put(static_cast<std::uint32_t>(ns / kBillion)).put(static_cast<std::uint32_t>(ns % kBillion));
    return text(frame);
  }
  [[nodiscard]] std::string message() const { return ros1_ ? bytes_ : std::string("\0\1\0\0", 4) + bytes_; }

 private:
  bool ros1_;
  std::string bytes_;
};

std::string mcap_record(char op, const std::string& body) { return std::string(1, op) + u64(body.size()) + body; }

std::uint32_t crc(const std::string& s) {
  return static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(s.data()), static_cast<uInt>(s.size())));
}

/// A number of protobuf: seven bits a byte, the lowest first.
std::string varint(std::uint64_t n) {
  if (n <= 0x7FU) return {static_cast<char>(n)};
  return static_cast<char>((n & 0x7FU) | 0x80U) + varint(n >> 7U);
}
/// A field of protobuf: its key, its length, its bytes.
std::string proto(int field, const std::string& bytes) {
  return static_cast<char>(field * 8 + 2) + varint(bytes.size()) + bytes;
}
std::string proto(int field, double value) { return static_cast<char>(field * 8 + 1) + raw(value); }
std::string proto(int field, std::int64_t value) {
  return static_cast<char>(field * 8) + varint(static_cast<std::uint64_t>(value));
}

std::string ros2_name(std::string type) {
  if (type.find('/') == std::string::npos) return type;
  return type.insert(type.find('/'), "/msg");
}

/// A number for each topic, from 1.
std::map<std::string, std::size_t> numbered(const std::vector<MadeMessage>& messages) {
  std::map<std::string, std::size_t> numbers;
  for (const MadeMessage& m : messages) numbers.emplace(m.topic, numbers.size() + 1);
  return numbers;
}

std::string ros1_fields(const std::vector<std::pair<std::string, std::string>>& values) {
  std::string bytes;
  for (const auto& [name, value] : values) bytes += sized(name + "=" + value);
  return sized(bytes);
}

}  // namespace

std::string packed(const std::string& method, const std::string& bytes) {
  if (method == "zstd") {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
    return out;
  }
  if (method == "lz4") {
    std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    return out;
  }
  if (method != "bz2") return bytes;
  auto size = static_cast<unsigned>(bytes.size() + 1000);
  std::string out(size, '\0'), source = bytes;
  BZ2_bzBuffToBuffCompress(out.data(), &size, source.data(), static_cast<unsigned>(source.size()), 1, 0, 0);
  out.resize(size);
  return out;
}

std::string scan_bytes(bool ros1, std::int64_t ns, const std::string& frame, std::vector<float> ranges,
                       const MadeFan& fan) {
  Fields out(ros1);
  out.header(ns, frame).put(0.0F).put(3.14159274F).put(fan.step_rad).put(fan.beam_step_s).put(0.1F);
  out.put(fan.range_min_m).put(fan.range_max_m);
  out.put(static_cast<std::uint32_t>(ranges.size()));
  for (const float range : ranges) out.put(range);
  return out.put(std::uint32_t{0}).message();
}

std::string odometry_bytes(bool ros1, std::int64_t ns, double x, double v_mps, const std::string& child,
                           double quaternion_w) {
  Fields out(ros1);
  out.header(ns, "odom").text(child).put(x).put(0.0).put(0.0).put(0.0).put(0.0).put(0.0).put(quaternion_w);
  for (int k = 0; k < 36; ++k) out.put(0.0);
  out.put(v_mps).put(0.0).put(0.0).put(0.0).put(0.0).put(0.25);
  for (int k = 0; k < 36; ++k) out.put(0.0);
  return out.message();
}

std::string frames_bytes(bool ros1, const std::vector<MadeFrame>& frames) {
  Fields out(ros1);
  out.put(static_cast<std::uint32_t>(frames.size()));
  for (const MadeFrame& frame : frames) {
    out.header(0, frame.parent).text(frame.child).put(frame.x).put(frame.y).put(0.5);
    for (const double part : frame.quaternion) out.put(part);
  }
  return out.message();
}

std::vector<MadeMessage> made_drive(bool ros1) {
  std::vector<MadeMessage> drive{
      {"/tf_static", "tf2_msgs/TFMessage", kBillion, frames_bytes(ros1, {{"base_link", "laser", 0.2, 0.0}})}};
  for (int k = 0; k < 10; ++k) {
    const std::int64_t ns = 1'600'000'000 * kBillion + k * 100'000'000LL;
    drive.push_back({"/scan", "sensor_msgs/LaserScan", ns,
                     scan_bytes(ros1, ns, "laser", {1.0F, 2.0F, 3.0F + 0.1F * static_cast<float>(k)})});
    drive.push_back({"/odom", "nav_msgs/Odometry", ns, odometry_bytes(ros1, ns, 0.1 * k)});
  }
  return drive;
}

std::string mcap_of(const std::vector<MadeMessage>& messages, const std::string& method, bool pack_each) {
  const std::string magic("\x89MCAP0\r\n", 8);
  const auto numbers = numbered(messages);
  std::string records;
  for (const MadeMessage& m : messages) {
    const std::size_t n = numbers.at(m.topic);
    records += mcap_record(3, u16(n) + sized(ros2_name(m.type)) + sized("ros2msg") + sized(""));
    const std::string encoding = m.type.find('/') == std::string::npos ? "protobuf" : "cdr";
    records += mcap_record(4, u16(n) + u16(n) + sized(m.topic) + sized(encoding) + sized(""));
    records += mcap_record(5, u16(n) + u32(0) + raw(m.ns) + raw(m.ns) + packed(pack_each ? "zstd" : "", m.bytes));
  }
  const std::string chunk = packed(method, records);
  const std::string data = magic + mcap_record(1, sized("ros2") + sized("made")) +
                           mcap_record(6, u64(0) + u64(0) + u64(records.size()) + u32(crc(records)) + sized(method) +
                                              u64(chunk.size()) + chunk);
  return data + mcap_record(15, u32(crc(data))) + mcap_record(2, std::string(20, '\0')) + magic;
}

std::string ros1_index(std::size_t entries, std::size_t claimed) {
  return ros1_fields({{"op", "\4"}, {"ver", u32(1)}, {"conn", u32(1)}, {"count", u32(entries)}}) + u32(claimed) +
         std::string(entries * 12, '\x2A');
}

std::string ros1_bag_of(const std::vector<MadeMessage>& messages, const std::string& method,
                        const std::string& behind) {
  const auto numbers = numbered(messages);
  std::string chunks, records;
  std::size_t put = 0, count = 0;
  for (const MadeMessage& m : messages) {
    const std::string conn = u32(numbers.at(m.topic));
    records += ros1_fields({{"op", "\7"}, {"conn", conn}, {"topic", m.topic}}) +
               ros1_fields({{"topic", m.topic}, {"type", m.type}, {"md5sum", "*"}, {"message_definition", ""}});
    records += ros1_fields({{"op", "\2"},
                            {"conn", conn},
                            {"time", u32(static_cast<std::size_t>(m.ns / kBillion)) +
                                         u32(static_cast<std::size_t>(m.ns % kBillion))}}) +
               sized(m.bytes);
    const bool full = !behind.empty() && put + 1 == messages.size() / 2;
    if (++put < messages.size() && !full) continue;
    chunks +=
        ros1_fields({{"op", "\5"}, {"compression", method.empty() ? "none" : method}, {"size", u32(records.size())}}) +
        sized(packed(method, records)) + behind;
    records.clear();
    ++count;
  }
  const auto head = [&](std::size_t index) {
    return "#ROSBAG V2.0\n" +
           ros1_fields({{"op", "\3"}, {"index_pos", u64(index)}, {"conn_count", u32(3)}, {"chunk_count", u32(count)}}) +
           sized(std::string(200, ' '));
  };
  return head(head(0).size() + chunks.size()) + chunks + (behind.empty() ? "" : ros1_index(1, 12));
}

void write_sqlite(const std::string& file, const std::vector<MadeMessage>& messages, bool pack_each) {
  sqlite3* base = nullptr;
  REQUIRE(sqlite3_open(file.c_str(), &base) == SQLITE_OK);
  const auto run = [&](const std::string& sql) {
    REQUIRE(sqlite3_exec(base, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, "
      "offered_qos_profiles TEXT);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB); BEGIN");
  const auto numbers = numbered(messages);
  for (const MadeMessage& m : messages) {
    const std::string n = std::to_string(numbers.at(m.topic));
    run("INSERT OR IGNORE INTO topics VALUES(" + n + ", '" + m.topic + "', '" + ros2_name(m.type) + "', 'cdr', '')");
    sqlite3_stmt* insert = nullptr;
    const std::string sql =
        "INSERT INTO messages(topic_id, timestamp, data) VALUES(" + n + ", " + std::to_string(m.ns) + ", ?)";
    REQUIRE(sqlite3_prepare_v2(base, sql.c_str(), -1, &insert, nullptr) == SQLITE_OK);
    const std::string bytes = packed(pack_each ? "zstd" : "", m.bytes);
    sqlite3_bind_blob(insert, 1, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
    REQUIRE(sqlite3_step(insert) == SQLITE_DONE);
    sqlite3_finalize(insert);
  }
  run("COMMIT");
  sqlite3_close(base);
}

sim::RecordedLog read_as_mcap(const std::vector<MadeMessage>& messages, const exchange::BagOptions& options) {
  const Scratch scratch;
  return exchange::load_bag(scratch.write("a.mcap", mcap_of(messages, "")), options);
}

std::vector<MadeMessage> made_foxglove_drive() {
  std::vector<MadeMessage> drive = made_drive(false);
  const std::string no_turn = proto(1, 0.0) + proto(2, 0.0) + proto(3, 0.0) + proto(4, 1.0);
  drive.front() = {"/frames", "foxglove.FrameTransform", 1,
                   proto(1, proto(1, std::int64_t{5})) + proto(2, "base_link") + proto(3, "laser") +
                       proto(4, proto(1, 0.2) + proto(2, 0.1)) + proto(5, no_turn)};
  std::string ranges;
  for (const double range : {1.0, 2.0, 7.5, 4.0}) ranges += raw(range);
  for (MadeMessage& message : drive) {
    if (message.topic != "/scan") continue;
    message.type = "foxglove.LaserScan";
    message.bytes = proto(1, proto(1, message.ns / kBillion) + proto(2, message.ns % kBillion)) + proto(2, "laser") +
                    proto(4, 0.0) + proto(5, 3.0) + proto(6, ranges) + proto(7, ranges);
  }
  return drive;
}

}  // namespace jaywalk::tests
