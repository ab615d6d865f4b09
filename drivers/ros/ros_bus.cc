#include "drivers/ros/ros_bus.h"

namespace jaywalk::ros {

namespace {

bool is_sound(const BaseMessage& message, Time now) noexcept {
  const bool is_known = message.id >= kWheel && message.id <= kOtherMaster;
  const bool has_size = message.size <= message.bytes.size();
  return is_known && has_size && is_recent(message.stamp_ns, now);
}

}  // namespace

SendResult RosBus::send(const CanFrame& frame) noexcept {
  const BaseMessage message{clock_.now().time_since_epoch().count(), frame.id, frame.size, frame.bytes};
  orders_->write(std::as_bytes(std::span(&message, 1)));
  return SendResult::kQueued;
}

bool RosBus::receive(ReceivedFrame& received) noexcept {
  BaseMessage message;
  for (std::size_t k = 0; k < kBaseRing.slots; ++k) {
    const SharedRing::Took took = states_->read(std::as_writable_bytes(std::span(&message, 1)));
    if (took == SharedRing::Took::kNothing) return false;
    if (took == SharedRing::Took::kMessage && is_sound(message, clock_.now())) {
      received.stamp = Time(Duration(message.stamp_ns));
      received.frame = {.id = message.id, .size = static_cast<std::uint8_t>(message.size), .bytes = message.bytes};
      return true;
    }
    ++malformed_;
  }
  return false;
}

CanHealth RosBus::health() const noexcept { return {.frames_lost = states_->lost(), .malformed = malformed_}; }

}  // namespace jaywalk::ros
