#include "drivers/can/byte_bus.h"

#include <utility>

namespace jaywalk {
namespace {

constexpr Duration kReopening = std::chrono::milliseconds(500);

}  // namespace

ByteBus::ByteBus(std::unique_ptr<wire::Link> link, Clock& clock) noexcept : link_(std::move(link)), clock_(clock) {
  refill();
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
