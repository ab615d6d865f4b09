#include "firmware/recording/recorder.h"

#include <algorithm>

namespace jaywalk {

Recorder::Recorder(const RecorderConfig& config)
    : writer_(config.file.empty() ? nullptr : std::make_unique<RecordingWriter>(config.file, config.setup)),
      ring_(std::max<std::size_t>(config.capacity, 1)) {}

TickRecord& Recorder::begin(Time now) noexcept {
  const std::uint64_t next = committed_.load(std::memory_order_relaxed);
  begun_in_ring_ = next - drained_.load(std::memory_order_acquire) < ring_.size();
  Slot& fresh = begun_in_ring_ ? slot(next) : spare_;
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
  const std::uint64_t next = committed_.load(std::memory_order_relaxed);
  slot(next).lost_before = lost_since_kept_;
  lost_since_kept_ = 0;
  committed_.store(next + 1, std::memory_order_release);
}

bool Recorder::drain() noexcept {
  bool taken = true;
  const std::uint64_t end = committed_.load(std::memory_order_acquire);
  for (std::uint64_t tick = drained_.load(std::memory_order_relaxed); tick != end; ++tick) {
    const Slot& oldest = slot(tick);
    if (writer_) taken = writer_->write(oldest.record, oldest.lost_before) && taken;
    last_drained_ = oldest.record.now;
    drained_.store(tick + 1, std::memory_order_release);
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

}  // namespace jaywalk
