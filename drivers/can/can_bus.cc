#include "drivers/can/can_bus.h"

#include <cstdio>

namespace jaywalk {
namespace {

constexpr Duration kReopening = std::chrono::milliseconds(500);

}  // namespace

std::string to_text(const CanFrame& frame) {
  std::array<char, 32> text{};
  int end =
      std::snprintf(text.data(), text.size(), frame.extended ? "%08X#" : "%03X#", static_cast<unsigned>(frame.id));
  for (std::size_t at = 0; !frame.remote && at < frame.size; ++at)
    end += std::snprintf(text.data() + end, text.size() - static_cast<std::size_t>(end), "%02X", frame.bytes[at]);
  return text.data() + std::string(frame.remote ? "R" : "");
}

std::string_view name(CanState state) noexcept {
  switch (state) {
    case CanState::kActive: return "error active";
    case CanState::kWarning: return "error warning";
    case CanState::kPassive: return "error passive";
    case CanState::kBusOff: return "bus-off";
    case CanState::kDown: return "interface down";
  }
  return "unknown state";
}

std::string_view name(SendResult result) noexcept {
  switch (result) {
    case SendResult::kQueued: return "queued";
    case SendResult::kQueueFull: return "send queue full";
    case SendResult::kOffBus: return "off the bus";
    case SendResult::kNotAFrame: return "not a frame";
    case SendResult::kSystemError: return "refused by the system";
  }
  return "unknown result";
}

SendResult ByteBus::send(const CanFrame& frame) noexcept {
  const std::scoped_lock held(turn_);
  link_->write(frame.payload());
  return link_->state() == wire::Link::State::kOpen ? SendResult::kQueued : SendResult::kOffBus;
}

bool ByteBus::receive(ReceivedFrame& received) noexcept {
  if (waiting_.empty()) refill();
  if (waiting_.empty()) return false;
  received = {first_frame(waiting_), read_};
  return true;
}

void ByteBus::refill() noexcept {
  const std::scoped_lock held(turn_);
  const Time now = clock_.now();
  if (link_->state() == wire::Link::State::kClosed && age(opened_, now) >= kReopening) {
    link_->open();
    opened_ = now;
  }
  if (link_->state() != wire::Link::State::kOpen) return;
  waiting_ = link_->read(room_);
  read_ = now;
}

CanHealth ByteBus::health() const noexcept {
  const std::scoped_lock held(turn_);
  return {.state = link_->state() == wire::Link::State::kOpen ? CanState::kActive : CanState::kDown};
}

}  // namespace jaywalk
