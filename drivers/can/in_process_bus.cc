#include "drivers/can/in_process_bus.h"

#include <algorithm>

namespace jaywalk {

// SplitMix64 (Steele, Lea and Flood, 2014): one addition and a mixing of the state.
bool InProcessBus::draw_loss() noexcept {
  std::uint64_t mixed = random_ += 0x9E3779B97F4A7C15;
  mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9;
  mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EB;
  mixed ^= mixed >> 31U;
  return static_cast<double>(mixed >> 11U) * 0x1p-53 < faults_.loss;
}

void InProcessBus::deliver(const CanFrame& frame, const Port& sender) noexcept {
  last_arrival_ = std::max(last_arrival_, clock_.now() + faults_.delay);
  for (Port& port : ports_) {
    if (&port == &sender || !port.on_bus()) continue;
    if (!draw_loss()) port.enqueue({frame, last_arrival_});
  }
}

void InProcessBus::Port::set_state(CanState state) noexcept {
  if (state == CanState::kBusOff && health_.state != CanState::kBusOff) ++health_.bus_off_count;
  if (state != CanState::kActive && state != health_.state) ++health_.error_frames;
  health_.state = state;
  if (!on_bus()) count_ = 0;
}

bool InProcessBus::Port::send(const CanFrame& frame) noexcept {
  if (!is_valid(frame) || !on_bus()) return false;
  if (refusals_ > 0) {
    --refusals_;
    return false;
  }
  bus_->deliver(frame, *this);
  return true;
}

bool InProcessBus::Port::receive(ReceivedFrame& received) noexcept {
  if (count_ == 0 || waiting_[oldest_].stamp > bus_->clock_.now()) return false;
  received = waiting_[oldest_];
  oldest_ = (oldest_ + 1) % kQueue;
  --count_;
  return true;
}

void InProcessBus::Port::enqueue(const ReceivedFrame& frame) noexcept {
  if (count_ == kQueue) {
    ++health_.frames_lost;
    return;
  }
  waiting_[(oldest_ + count_) % kQueue] = frame;
  ++count_;
}

}  // namespace jaywalk
