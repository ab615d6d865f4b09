#include <map>
#include <string>

#include "apps/formats/bag_file.h"
#include "apps/formats/mcap_writer.h"
#include "apps/formats/wire_reader.h"

namespace jaywalk::exchange {
namespace {

constexpr std::uint64_t kRecordHead = 9;  // what it is, and how long
constexpr const char* kMcapRemedy = "take an undamaged copy of it, or what 'mcap recover' makes of this one";

struct Channel {
  std::string topic, type;
  Wire wire = Wire::kOther;
};

Wire wire_of(std::string_view encoding) {
  if (encoding == "cdr") return Wire::kCdr;
  if (encoding == "ros1") return Wire::kRos1;
  return encoding == "protobuf" ? Wire::kProtobuf : Wire::kOther;
}

/// The records of a file from its begin to the end of its data.
class McapFile {
 public:
  explicit McapFile(const std::filesystem::path& path) : file_(path, kMcapRemedy) {
    const std::uint64_t ends = kMcapMagic.size();
    if (file_.read(0, ends) != kMcapMagic) file_.refuse(0, "no MCAP file");
    is_cut_ = file_.size() < 2 * ends || file_.read(file_.size() - ends, ends) != kMcapMagic;
    crc_ = crc_of(kMcapMagic);
    next_ = ends;
  }

  /// The next record's head; false at the end of the data, and where a file that was cut has no whole one left.
  bool next() {
    at_ = next_;
    const std::uint64_t left = file_.size() - at_;
    if (is_cut_ && left < kRecordHead) return false;
    const std::string head = file_.read(at_, kRecordHead);
    WireReader in(head);
    op_ = in.number<std::uint8_t>();
    bytes_ = in.u64();
    if (is_cut_ && bytes_ > left - kRecordHead) return false;
    if (bytes_ > left - kRecordHead) refuse("a record that is longer than the file");
    next_ = at_ + kRecordHead + bytes_;
    if (op_ == kFooter) refuse("the footer comes before the end of the data");
    return op_ != kDataEnd;
  }
  /// It does not end as MCAP files do: the recorder was killed, or the disk was full.
  [[nodiscard]] bool is_cut() const { return is_cut_; }
  [[nodiscard]] std::string cut_at() const {
    return file_.name() + ": byte " + std::to_string(at_) + ": the file is cut short here";
  }
  [[nodiscard]] std::uint8_t op() const { return op_; }
  [[nodiscard]] std::uint64_t begin() const { return at_ + kRecordHead; }
  /// The record's bytes; each record's once, for the check sum of all of them.
  [[nodiscard]] std::string body() {
    std::string all = file_.read(at_, kRecordHead + bytes_);
    crc_ = crc_of(all, crc_);
    return all.substr(kRecordHead);
  }
  [[nodiscard]] std::string unpacked(std::string_view method, std::string_view packed, std::uint64_t bytes) const {
    return file_.unpacked(at_, method, packed, bytes);
  }
  void check_data_end() {
    const std::string body = file_.read(at_ + kRecordHead, bytes_);
    const std::uint32_t said = WireReader(body).u32();
    if (said != 0 && said != crc_) refuse("the data's check sum is wrong");
  }
  [[noreturn]] void refuse(const std::string& cause) const { file_.refuse(at_, cause); }

 private:
  ByteFile file_;
  bool is_cut_ = false;
  std::uint64_t at_ = 0, next_ = 0, bytes_ = 0;
  std::uint8_t op_ = 0;
  std::uint32_t crc_ = 0;
};

/// Schemas, channels and messages, in chunks or not.
class McapMessages {
 public:
  McapMessages(const McapFile& file, const BagSink& sink) : file_(file), sink_(sink) {}

  void take(std::uint8_t op, std::string_view body) {
    WireReader in(body);
    if (op == kSchema) {
      const std::uint16_t number = in.u16();
      schemas_[number] = ros1_name(in.sized());
    } else if (op == kChannel) {
      add_channel(in);
    } else if (op == kMessage) {
      pass_on(in);
    } else if (op == kChunk) {
      open_chunk(in);
    }
    if (!in.ok()) file_.refuse("a record that is too short for what it is");
  }
  [[nodiscard]] std::size_t passed() const { return passed_; }

 private:
  void add_channel(WireReader& in) {
    const std::uint16_t number = in.u16(), schema = in.u16();
    const std::string_view topic = in.sized(), encoding = in.sized();
    channels_[number] = {std::string(topic), schemas_[schema], wire_of(encoding)};
    if (channels_[number].wire == Wire::kOther) channels_[number].type += " in " + std::string(encoding);
  }
  void pass_on(WireReader& in) {
    const std::uint16_t number = in.u16();
    (void)in.u32();  // its running number
    const Time logged{std::chrono::nanoseconds(in.u64())};
    (void)in.u64();  // when it was published
    const auto channel = channels_.find(number);
    if (channel == channels_.end()) file_.refuse("a message of a channel that the file does not describe");
    if (!in.ok()) return;
    ++passed_;
    sink_({channel->second.topic, channel->second.type, channel->second.wire, logged, in.rest()});
  }
  void open_chunk(WireReader& in) {
    (void)in.u64(), (void)in.u64();  // of its first and last message
    const std::uint64_t bytes = in.u64();
    const std::uint32_t crc = in.u32();
    const std::string_view method = in.sized();
    const std::string_view packed = in.take(in.u64());
    if (!in.ok()) return;
    const std::string unpacked = file_.unpacked(method, packed, bytes);
    if (crc != 0 && crc_of(unpacked) != crc) file_.refuse("a chunk's check sum is wrong");
    WireReader records(unpacked);
    while (!records.empty()) {
      const auto op = records.number<std::uint8_t>();
      const std::string_view body = records.take(records.u64());
      if (!records.ok() || op == kChunk) file_.refuse("a chunk with something else than records in it");
      take(op, body);
    }
  }

  const McapFile& file_;
  const BagSink& sink_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::size_t passed_ = 0;
};

bool is_mcap(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string head(kMcapMagic.size(), '\0');
  return in.read(head.data(), static_cast<std::streamsize>(head.size())) && head == kMcapMagic;
}

}  // namespace

std::string read_mcap(const std::filesystem::path& path, const BagSink& sink) {
  McapFile file(path);
  McapMessages messages(file, sink);
  while (file.next()) messages.take(file.op(), file.body());
  if (!file.is_cut()) {
    file.check_data_end();
    return "";
  }
  if (messages.passed() == 0) file.refuse("the file is cut short, and no message is whole");
  return file.cut_at() + ": the " + std::to_string(messages.passed()) + " whole messages before count\n";
}

FilePart find_attachment(const std::filesystem::path& path, std::string_view name) {
  if (!is_mcap(path)) return {0, 0};
  McapFile file(path);
  while (file.next()) {
    if (file.op() != kAttachment) continue;
    const std::string body = file.body();
    WireReader in(body);
    (void)in.u64(), (void)in.u64();  // when it was recorded and made
    const std::string_view said = in.sized(), type = in.sized();
    const std::uint64_t bytes = in.u64(), before = 8 + 8 + 4 + said.size() + 4 + type.size() + 8;
    (void)in.take(bytes);
    const std::uint32_t crc = in.u32();
    if (!in.ok()) file.refuse("a record that is too short for what it is");
    if (crc != 0 && crc_of(std::string_view(body).substr(0, before + bytes)) != crc)
      file.refuse("an attachment's check sum is wrong");
    if (said == name) return {file.begin() + before, bytes};
  }
  return {0, 0};
}

}  // namespace jaywalk::exchange
