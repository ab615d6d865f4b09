#include "drivers/can/can_bus.h"

#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr Duration kReopening = std::chrono::milliseconds(500);

}  // namespace

std::string to_text(const CanFrame& frame) {
  std::string text = formatted(frame.extended ? "%08X#" : "%03X#", static_cast<unsigned>(frame.id));
  if (frame.remote) return text + "R";
  for (const std::uint8_t byte : frame.payload()) text += formatted("%02X", byte);
  return text;
}

std::string_view name(CanState state) noexcept {
  constexpr std::array<std::string_view, 5> kNames{"error active", "error warning", "error passive", "bus-off",
                                                   "interface down"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "unknown state";
}

bool ByteBus::send(const CanFrame& frame) noexcept {
  const std::scoped_lock held(turn_);
  link_->write(frame.payload());
  return link_->state() == wire::Link::State::kOpen;
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
