#include "drivers/ros/ring_link.h"

namespace jaywalk::ros {

void RingLink::open() noexcept {
  ring_->skip();
  state_ = State::kOpen;
}

wire::Bytes RingLink::read(std::span<std::uint8_t>) noexcept {
  if (state_ != State::kOpen) return {};
  switch (ring_->read(std::as_writable_bytes(std::span(message_)))) {
    case SharedRing::Took::kNothing:
      return {};
    case SharedRing::Took::kTorn:
      return wire::Bytes(message_).first(1);
    case SharedRing::Took::kMessage:
      break;
  }
  return message_;
}

void RingLink::wait(Duration most) noexcept {
  if (state_ == State::kClosed) ring_->skip();
  ring_->wait(most);
}

}  // namespace jaywalk::ros
