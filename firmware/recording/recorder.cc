#include "firmware/recording/recorder.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "drivers/wire/byte_reader.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr std::array<unsigned char, 8> kMagic{'J', 'A', 'Y', 'W', 'A', 'L', 'K', '\n'};
constexpr std::size_t kEntryHeadBytes = 12;
constexpr std::size_t kBlockBytes = 1U << 16U;

std::uint32_t crc_of(std::span<const unsigned char> bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(crc32(before, bytes.data(), static_cast<uInt>(bytes.size())));
}

std::span<const unsigned char> bytes_of(const std::string& text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::uint32_t word_in(std::span<const unsigned char> bytes, std::size_t at) {
  return wire::little_endian<std::uint32_t>(bytes.subspan(at));
}

void put_word(std::uint32_t word, std::span<unsigned char> bytes, std::size_t at) {
  wire::put_little_endian(word, bytes.subspan(at));
}

/// Length, its inverse and `check`: before an entry's bytes their CRC; at the end (length 0) the number of entries.
std::array<unsigned char, kEntryHeadBytes> encode(std::uint32_t length, std::uint32_t check) {
  std::array<unsigned char, kEntryHeadBytes> bytes{};
  put_word(length, bytes, 0);
  put_word(~length, bytes, 4);
  put_word(check, bytes, 8);
  return bytes;
}

}  // namespace

bool is_recording(const std::string& file) {
  std::array<unsigned char, kMagic.size()> head{};
  GzipFile stream(file.c_str());
  return stream.is_open() && stream.read(head.data(), head.size()) == head.size() && head == kMagic;
}

RecordingWriter::RecordingWriter(const std::string& file, const std::string& setup)
    : file_(file), block_(std::max(kBlockBytes + kEntryHeadBytes + kMaxEntryBytes, setup.size() + 32)) {
  if (setup.size() > kMaxSetupBytes)
    throw StartupError(file + ": a setup of " + std::to_string(setup.size()) + " bytes", "keep it below 16 MiB");
  std::array<unsigned char, kMagic.size() + 8> head{};
  std::memcpy(head.data(), kMagic.data(), kMagic.size());
  put_word(kRecordingVersion, head, kMagic.size());
  put_word(static_cast<std::uint32_t>(setup.size()), head, kMagic.size() + 4);
  std::array<unsigned char, 4> check{};
  put_word(crc_of(bytes_of(setup), crc_of(head)), check, 0);
  put(head);
  put(bytes_of(setup));
  put(check);
}

void RecordingWriter::put(std::span<const unsigned char> bytes) noexcept {
  if (!bytes.empty()) std::memcpy(block_.data() + used_, bytes.data(), bytes.size());
  used_ += bytes.size();
}

bool RecordingWriter::write(const TickRecord& record, std::uint64_t lost_before) noexcept {
  if (!header_written_) write_out();
  if (file_.has_failed()) return false;
  const std::span<unsigned char> entry = std::span(block_).subspan(used_);
  const std::size_t length = encoder_.encode(record, lost_before, entry.subspan(kEntryHeadBytes));
  const auto head = encode(static_cast<std::uint32_t>(length), crc_of(entry.subspan(kEntryHeadBytes, length)));
  std::memcpy(entry.data(), head.data(), head.size());
  used_ += kEntryHeadBytes + length;
  ++entries_;
  if (written_at_ == kNever) written_at_ = record.now;
  if (used_ >= kBlockBytes || record.now - written_at_ >= kLongestWait) {
    write_out();
    written_at_ = record.now;
  }
  return !file_.has_failed();
}

void RecordingWriter::write_out() noexcept {
  const std::span<const unsigned char> block = std::span<const unsigned char>(block_).first(used_);
  const std::size_t taken = file_.append(block);
  used_ = 0;
  if (taken == block.size()) {
    header_written_ = true;
    return;
  }
  std::size_t whole = 0;  // entries; of a header that is cut nothing is kept
  while (header_written_ && taken - whole >= kEntryHeadBytes) {
    const std::size_t entry = kEntryHeadBytes + word_in(block, whole);
    if (taken - whole < entry) break;
    whole += entry;
  }
  file_.take_back(taken - whole);
}

bool RecordingWriter::close() noexcept {
  if (std::exchange(closed_, true)) return !file_.has_failed();
  write_out();
  if (!file_.has_failed()) {
    put(encode(0, entries_));
    write_out();
  }
  return file_.close();
}

RecordingReader::RecordingReader(const std::string& file, FilePart part)
    : file_(file), stream_(file.c_str(), part), entry_(kMaxEntryBytes) {
  if (!stream_.is_open())
    throw StartupError(file + ": cannot be read", "give a recording.jwr that a run left in its --out");
  std::error_code unknown;  // the size then reads as the greatest: a bar that does not move
  bytes_ = std::min(part.bytes, static_cast<std::uint64_t>(std::filesystem::file_size(file, unknown)));
  read_header();
}

void RecordingReader::damaged(const std::string& cause) const {
  throw StartupError(file_ + ": byte " + std::to_string(position_) + ": " + cause,
                     "take an undamaged copy of the recording");
}

void RecordingReader::read_header() {
  std::array<unsigned char, kMagic.size() + 8> head{};
  if (!read(head.data(), head.size())) damaged("too short for a recording");
  if (std::memcmp(head.data(), kMagic.data(), kMagic.size()) != 0) damaged("not a recording");
  const std::uint32_t version = word_in(head, kMagic.size()), setup_bytes = word_in(head, kMagic.size() + 4);
  if (version != kRecordingVersion) {
    throw StartupError(file_ + ": byte 8: format version " + std::to_string(version) + ", this program reads " +
                           std::to_string(kRecordingVersion) + " alone",
                       "replay it with the jaywalk that recorded it");
  }
  if (setup_bytes > kMaxSetupBytes) damaged("the header is damaged");
  setup_.resize(setup_bytes);
  std::array<unsigned char, 4> check{};
  if (!read(reinterpret_cast<unsigned char*>(setup_.data()), setup_bytes) || !read(check.data(), check.size()))
    damaged("the header is cut");
  if (word_in(check, 0) != crc_of(bytes_of(setup_), crc_of(head))) damaged("the header is damaged");
  position_ = head.size() + setup_bytes + check.size();
}

bool RecordingReader::cut_short() {
  ended_ = true;
  warning_ = file_ + ": byte " + std::to_string(position_) + ": cut short after " + std::to_string(entries_) +
             " ticks; what stands before is good";
  return false;
}

bool RecordingReader::check_end(std::uint32_t entries) {
  if (entries != entries_)
    damaged("the end mark counts " + std::to_string(entries) + " ticks, there are " + std::to_string(entries_));
  position_ += kEntryHeadBytes;
  unsigned char beyond = 0;
  if (read(&beyond, 1)) damaged("something follows the end mark");
  ended_ = true;
  return false;
}

bool RecordingReader::next(TickRecord& record) {
  if (ended_) return false;
  std::array<unsigned char, kEntryHeadBytes> bytes{};
  if (!read(bytes.data(), bytes.size())) return cut_short();
  const std::uint32_t length = word_in(bytes, 0), check = word_in(bytes, 8);
  if (word_in(bytes, 4) != ~length || length > kMaxEntryBytes) damaged("an entry's length is damaged");
  if (length == 0) return check_end(check);
  if (!read(entry_.data(), length)) return cut_short();
  const std::span<const unsigned char> entry = std::span<const unsigned char>(entry_).first(length);
  if (crc_of(entry) != check) damaged("an entry's check sum is wrong");
  if (!decoder_.decode(entry, record, lost_before_)) damaged("an entry holds values that no tick has");
  position_ += kEntryHeadBytes + length;
  ++entries_;
  return true;
}

Recorder::Recorder(const RecorderConfig& config)
    : writer_(config.file.empty() ? nullptr : std::make_unique<RecordingWriter>(config.file, config.setup)),
      ring_(config.capacity) {}

TickRecord& Recorder::begin(Time now) noexcept {
  Slot* const free = ring_.draft();
  begun_in_ring_ = free != nullptr;
  Slot& fresh = begun_in_ring_ ? *free : spare_;
  fresh.record = TickRecord{};
  fresh.record.now = now;
  return fresh.record;
}

void Recorder::commit() noexcept {
  if (!begun_in_ring_) {
    ++lost_since_kept_;
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  ring_.draft()->lost_before = std::exchange(lost_since_kept_, 0);
  ring_.publish();
}

bool Recorder::drain() noexcept {
  bool taken = true;
  for (std::size_t left = ring_.capacity(); left > 0 && ring_.front() != nullptr; --left, ring_.pop()) {
    const Slot& oldest = *ring_.front();
    if (writer_) taken = writer_->write(oldest.record, oldest.lost_before) && taken;
    last_drained_ = oldest.record.now;
  }
  if (!taken) note_loss();
  return taken;
}

void Recorder::continue_in(const std::string& file, const std::string& setup) {
  auto next = std::make_unique<RecordingWriter>(file, setup);
  if (!writer_->close()) lost_ = writer_->complaint();
  writer_ = std::move(next);
}

bool Recorder::close() noexcept {
  const bool drained = drain();
  return (!writer_ || writer_->close()) && drained;
}

AppendFile::AppendFile(const std::string& file)
    : file_(file), descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) {
    throw StartupError(file + ": cannot be written: " + std::strerror(errno),
                       "choose an --out folder that exists and may be written");
  }
}

std::size_t AppendFile::append(std::span<const unsigned char> bytes) noexcept {
  std::size_t taken = 0;
  while (taken < bytes.size() && error_ == 0) {
    const ssize_t count = ::write(descriptor_, bytes.data() + taken, bytes.size() - taken);
    if (count > 0)
      taken += static_cast<std::size_t>(count);
    else if (count == 0 || errno != EINTR)
      error_ = count == 0 ? ENOSPC : errno;
  }
  size_ += taken;
  return taken;
}

void AppendFile::take_back(std::size_t bytes) noexcept {
  size_ -= bytes;
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0 && error_ == 0) error_ = errno;
}

bool AppendFile::close() noexcept {
  if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  return error_ == 0;
}

std::string AppendFile::complaint() const {
  return error_ == 0 ? "" : file_ + ": the disk takes no more of it: " + std::strerror(error_);
}

}  // namespace jaywalk
