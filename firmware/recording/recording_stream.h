#pragma once
// A recording on disk (recording.jwr), little endian:
//
//   "JAYWALK\n"  u32 version  u32 setup bytes  setup text  u32 CRC of all that came before
//   then for each tick      u32 length  u32 ~length  u32 CRC of the bytes  bytes (tick_entry.h)
//   and at the proper end   u32 0       u32 ~0       u32 number of entries, modulo 2^32
//
// CRC: the one of zlib and PNG. A file without its end was cut short (power lost, disk full); what
// stands before the cut is good.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware/recording/append_file.h"
#include "firmware/recording/tick_entry.h"
#include "firmware/recording/tick_record.h"
#include "hal/text_file.h"

namespace jaywalk {

inline constexpr std::size_t kMaxSetupBytes = 16U << 20U;

/// Whether `file`, packed with gzip or not, begins as a recording of ours does; false where it cannot be read.
[[nodiscard]] bool is_recording(const std::string& file);

/// Writes a recording, a block of entries at a time: kLongestWait of ticks at most. A full disk takes nothing from the
/// first entry on that it did not take whole. Only the constructor allocates.
class RecordingWriter {
 public:
  /// `setup`: what it takes to build the same controller again, in the caller's own words; at most
  /// kMaxSetupBytes. Throws StartupError when the file cannot be made.
  RecordingWriter(const std::string& file, const std::string& setup);
  /// Writes the end mark.
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  static constexpr Duration kLongestWait = std::chrono::milliseconds(100);

  /// False when the disk took no more, of this or of what came before.
  bool write(const TickRecord& record, std::uint64_t lost_before) noexcept;
  /// Writes the end mark and closes; false when anything was lost on the way to the disk.
  bool close() noexcept;
  /// AppendFile's.
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
  /// Throws StartupError "FILE: byte N: cause" for what is no recording, another version's, or damaged.
  /// `part`: where in the file the recording stands.
  explicit RecordingReader(const std::string& file, FilePart part = {});

  [[nodiscard]] const std::string& setup() const { return setup_; }
  /// False at the end, cut or proper. Throws StartupError with the place for a damaged entry.
  [[nodiscard]] bool next(TickRecord& record);
  /// How much of the file has been read, 0 to 1.
  [[nodiscard]] double share_read() const;
  /// Records that the recorder dropped between the last two that next() gave.
  [[nodiscard]] std::uint64_t lost_before() const { return lost_before_; }
  /// After next() returned false: where and how the file was cut; empty for a proper end.
  [[nodiscard]] const std::string& warning() const { return warning_; }

 private:
  [[nodiscard]] bool read(unsigned char* to, std::size_t bytes);
  void read_header();
  void check_end(std::uint32_t entries);
  void cut_short();
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

}  // namespace jaywalk
