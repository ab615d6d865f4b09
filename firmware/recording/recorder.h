#pragma once
// From the tick to the disk without making the tick wait: a ring of records in memory, filled by
// the loop's thread and emptied by another, or by the main loop between ticks.
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware/recording/recording_stream.h"
#include "firmware/recording/tick_record.h"

namespace jaywalk {

struct RecorderConfig {
  std::string file;            ///< recording.jwr; empty: records live in the ring and go nowhere
  std::string setup;           ///< what it takes to build the same controller again
  std::size_t capacity = 128;  ///< ticks that the ring holds: 2.6 s at 50 Hz, about 68 kB each
};

/// All memory is taken and the file opened in the constructor.
///
/// When the ring is full the tick's record is dropped and counted; the next that is kept says how
/// many went missing before it. The tick never waits for the disk.
class Recorder {
 public:
  /// Throws StartupError when the file cannot be written.
  explicit Recorder(const RecorderConfig& config);

  /// Loop's thread: a fresh record for the tick at `now`, valid until the next begin().
  [[nodiscard]] TickRecord& begin(Time now) noexcept;
  /// Loop's thread: the record that begin() gave is complete.
  void commit() noexcept;

  /// Draining thread: writes out what has been committed. False when the disk takes no more; the
  /// ring is emptied all the same, so that ticks are lost and counted rather than held up.
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
  /// The disk takes no more of the recording, or of the tables beside it; or the draining thread has hung for so long
  /// that the ring is full. Loop's thread.
  [[nodiscard]] bool is_losing() const noexcept { return losing_.load(std::memory_order_relaxed) || !begun_in_ring_; }
  void note_loss() noexcept { losing_.store(true, std::memory_order_relaxed); }

  /// Records dropped so far because the ring was full. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Slot {
    TickRecord record;
    std::uint64_t lost_before = 0;
  };
  [[nodiscard]] Slot& slot(std::uint64_t tick) noexcept { return ring_[tick % ring_.size()]; }

  std::unique_ptr<RecordingWriter> writer_;
  std::vector<Slot> ring_;
  Slot spare_;  ///< what a tick fills while the ring is full
  bool begun_in_ring_ = true;
  Time last_drained_ = kNever;
  std::string lost_;  ///< what the disk did not take of a recording that is closed
  std::uint64_t lost_since_kept_ = 0;
  std::atomic<std::uint64_t> committed_{0};  ///< records ever put in; written by the loop
  std::atomic<std::uint64_t> drained_{0};    ///< records ever taken out; written by the drain
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<bool> losing_{false};
};

}  // namespace jaywalk
