#pragma once
// Recordings, and the ring in memory through which ticks reach the disk without waiting for it.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware/recording/tick_record.h"
#include "hal/text_file.h"

namespace jaywalk {

/// Appends bytes without a buffer of its own. After the first failure it takes no more: what stands before it is then
/// the file, without a gap. Only the constructor allocates. Thread: one.
class AppendFile {
 public:
  /// Makes the file, or empties it. Throws StartupError where it cannot.
  explicit AppendFile(const std::string& file);
  ~AppendFile() { close(); }
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// How many of the bytes the disk took: all of them, or fewer and has_failed() from then on.
  [[nodiscard]] std::size_t append(std::span<const unsigned char> bytes) noexcept;
  /// Takes the last `bytes` back: a row or an entry of which the disk took a part.
  void take_back(std::size_t bytes) noexcept;
  /// False when the disk lost anything, now or before.
  bool close() noexcept;

  [[nodiscard]] bool has_failed() const noexcept { return error_ != 0; }
  [[nodiscard]] std::size_t bytes() const noexcept { return size_; }
  /// "out/robot.csv: the disk takes no more of it: No space left on device"; empty while all is well. Allocates.
  [[nodiscard]] std::string complaint() const;

 private:
  std::string file_;
  int descriptor_;
  std::size_t size_ = 0;
  int error_ = 0;  ///< errno of the first failure
};

// A tick's record as bytes: the fields in the order of tick_entry.cc, little endian, without padding. A scan and a fix
// are written only where their sequence is new; only beams in use count. What a robot of several scanners has beyond
// that stands at the end: of one scanner there is nothing.

/// Of the fields and their order; no other version is read.
inline constexpr std::uint32_t kRecordingVersion = 7;

/// Most bytes of an encoded record: every beam, mover and point of a path (two changes of 34 bits), and the rest.
inline constexpr std::size_t kMaxEntryBytes =
    4 * kMaxBeams * kMostScanners + 40 * kMaxObservedMovers + 10 * kMaxPathPoints + 1024;

/// Turns records into bytes; remembers which scan and fix it wrote last. Never allocates or throws.
class TickEncoder {
 public:
  /// Bytes written to the front of `out`, which holds kMaxEntryBytes. `lost_before`: records dropped since the last.
  std::size_t encode(const TickRecord& record, std::uint64_t lost_before, std::span<unsigned char> out) noexcept;

 private:
  bool first_ = true;
  std::uint32_t scan_sequence_ = 0, fix_sequence_ = 0;
  std::array<std::uint32_t, kMostScanners - 1> others_{};  ///< sequences of the other scanners' scans
};

/// Turns bytes back into records; keeps the last scan and fix for those that bring none.
class TickDecoder {
 public:
  /// False when the bytes are no record: too few, too many, or a value out of its range.
  [[nodiscard]] bool decode(std::span<const unsigned char> in, TickRecord& record, std::uint64_t& lost_before) noexcept;

 private:
  LaserScan scan_;
  OfOthers<LaserScan> others_;
  OutsideFix fix_;
};

// A recording on disk (recording.jwr), little endian:
//
//   "JAYWALK\n"  u32 version  u32 setup bytes  setup text  u32 CRC of all that came before
//   then for each tick      u32 length  u32 ~length  u32 CRC of the bytes  bytes of the record
//   and at the proper end   u32 0       u32 ~0       u32 number of entries, modulo 2^32
//
// CRC: the one of zlib and PNG. A file without its end was cut short (power, disk); what stands before that is good.

inline constexpr std::size_t kMaxSetupBytes = 16U << 20U;

/// Whether `file`, packed with gzip or not, begins as a recording of ours does; false where it cannot be read.
[[nodiscard]] bool is_recording(const std::string& file);

/// Writes a recording, a block of entries at a time: kLongestWait of ticks at most. A full disk takes nothing from the
/// first entry on that it did not take whole. Only the constructor allocates.
class RecordingWriter {
 public:
  /// `setup`: the ControlSetup as text, at most kMaxSetupBytes. Throws StartupError when the file cannot be made.
  RecordingWriter(const std::string& file, const std::string& setup);
  /// Writes the end mark.
  ~RecordingWriter() { close(); }

  static constexpr Duration kLongestWait = std::chrono::milliseconds(100);

  /// False when the disk took no more, of this or of what came before.
  bool write(const TickRecord& record, std::uint64_t lost_before) noexcept;
  /// Writes the end mark and closes; false when anything was lost on the way to the disk.
  bool close() noexcept;
  [[nodiscard]] std::string complaint() const { return file_.complaint(); }
  /// Of the file, with what is not on the disk yet.
  [[nodiscard]] std::uintmax_t bytes() const noexcept { return file_.bytes() + used_; }

 private:
  void put(std::span<const unsigned char> bytes) noexcept;
  void write_out() noexcept;

  AppendFile file_;
  TickEncoder encoder_;
  std::vector<unsigned char> block_;  ///< what is not on the disk yet: the header, or whole entries
  std::size_t used_ = 0;
  bool header_written_ = false;
  bool closed_ = false;
  Time written_at_ = kNever;
  std::uint32_t entries_ = 0;
};

/// Reads a recording, packed with gzip or not, a record at a time. Bytes in messages are those of the unpacked one.
class RecordingReader {
 public:
  /// Throws StartupError "FILE: byte N: cause" for no recording, another version's, or a damaged one in that `part`.
  explicit RecordingReader(const std::string& file, FilePart part = {});

  [[nodiscard]] const std::string& setup() const { return setup_; }
  /// False at the end, cut or proper. Throws StartupError with the place for a damaged entry.
  [[nodiscard]] bool next(TickRecord& record);
  /// How much of the file has been read, 0 to 1.
  [[nodiscard]] double share_read() const { return stream_.bytes_used() / static_cast<double>(bytes_); }
  /// Records that the recorder dropped between the last two that next() gave.
  [[nodiscard]] std::uint64_t lost_before() const { return lost_before_; }
  /// After next() returned false: where and how the file was cut; empty for a proper end.
  [[nodiscard]] const std::string& warning() const { return warning_; }

 private:
  [[nodiscard]] bool read(unsigned char* to, std::size_t bytes) { return stream_.read(to, bytes) == bytes; }
  void read_header();
  /// Both return false: nothing follows.
  bool check_end(std::uint32_t entries);
  bool cut_short();
  [[noreturn]] void damaged(const std::string& cause) const;

  std::string file_;
  GzipFile stream_;
  std::uint64_t bytes_ = 0;     ///< of the whole file
  std::uint64_t position_ = 0;  ///< byte that the entry at hand begins with
  std::string setup_;
  TickDecoder decoder_;
  std::vector<unsigned char> entry_;
  std::uint32_t entries_ = 0;
  std::uint64_t lost_before_ = 0;
  bool ended_ = false;
  std::string warning_;
};

/// Hands every T from one writing thread to one reading thread, in order; neither ever waits, nor allocates after the
/// constructor. A full ring takes no more, and the writer is told.
template <class T, std::size_t N = 0>
class Ring {
 public:
  explicit Ring(std::size_t capacity = N) : slots_(capacity) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }
  /// Writer's thread: the slot to fill; null when full.
  [[nodiscard]] T* draft() noexcept {
    const std::size_t next = written_.load(std::memory_order_relaxed);
    if (next - read_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[next % slots_.size()];
  }
  /// Writer's thread: the draft is complete.
  void publish() noexcept { written_.fetch_add(1, std::memory_order_release); }
  /// Reader's thread: the oldest; null when there is none. Valid until pop().
  [[nodiscard]] const T* front() const noexcept {
    const std::size_t next = read_.load(std::memory_order_relaxed);
    if (next == written_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[next % slots_.size()];
  }
  void pop() noexcept { read_.fetch_add(1, std::memory_order_release); }

 private:
  std::vector<T> slots_;
  std::atomic<std::size_t> written_{0};
  std::atomic<std::size_t> read_{0};
};

struct RecorderConfig {
  std::string file;            ///< recording.jwr; empty: records live in the ring and go nowhere
  std::string setup;           ///< what it takes to build the same controller again
  std::size_t capacity = 128;  ///< ticks that the ring holds: 2.6 s at 50 Hz, about 68 kB each
};

/// All memory is taken and the file opened in the constructor. When the ring is full the tick's record is dropped and
/// counted; the next that is kept says how many went missing before it. The tick never waits for the disk.
class Recorder {
 public:
  /// Throws StartupError when the file cannot be written.
  explicit Recorder(const RecorderConfig& config);

  /// Loop's thread: a fresh record for the tick at `now`, valid until the next begin().
  [[nodiscard]] TickRecord& begin(Time now) noexcept;
  /// Loop's thread: the record that begin() gave is complete.
  void commit() noexcept;

  /// Draining thread: writes out what has been committed. False when the disk takes no more; the ring is emptied
  /// anyway.
  bool drain() noexcept;
  /// Draining thread, after the last tick: drains and ends the file. False when the disk lost anything.
  bool close() noexcept;
  /// Draining thread: what is drained from now on goes to a recording of its own. Throws StartupError where its file
  /// cannot be made, and goes on in the one before. Allocates.
  void continue_in(const std::string& file, const std::string& setup);
  /// Draining thread: nothing more is recorded.
  void end_recording() noexcept { writer_.reset(); }
  /// Bytes of the recording; 0: none is made. Draining thread.
  [[nodiscard]] std::uintmax_t bytes() const noexcept { return writer_ ? writer_->bytes() : 0; }
  /// The newest tick that was drained. Draining thread.
  [[nodiscard]] Time last_drained() const noexcept { return last_drained_; }

  /// What the disk did not take of the recording; empty: it has taken all. Draining thread.
  [[nodiscard]] std::string complaint() const { return lost_.empty() && writer_ ? writer_->complaint() : lost_; }
  /// The disk takes no more of recording or tables, or the draining thread hangs: the ring is full. Loop's thread.
  [[nodiscard]] bool is_losing() const noexcept { return losing_.load(std::memory_order_relaxed) || !begun_in_ring_; }
  void note_loss() noexcept { losing_.store(true, std::memory_order_relaxed); }

  /// Records dropped so far because the ring was full. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Slot {
    TickRecord record;
    std::uint64_t lost_before = 0;
  };

  std::unique_ptr<RecordingWriter> writer_;
  Ring<Slot> ring_;
  Slot spare_;  ///< what a tick fills while the ring is full
  bool begun_in_ring_ = true;
  Time last_drained_ = kNever;
  std::string lost_;  ///< what the disk did not take of a recording that is closed
  std::uint64_t lost_since_kept_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<bool> losing_{false};
};

}  // namespace jaywalk
