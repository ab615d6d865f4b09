#pragma once
#include <memory>

#include "drivers/can/byte_bus.h"
#include "hil/emulators/byte_server.h"

namespace jaywalk::emulators {

/// The device's end of a line as a bus: frames carry its bytes.
class ServedBytes final : public CanBus {
 public:
  /// `clock` outlives it.
  ServedBytes(std::unique_ptr<ByteServer> wire, Clock& clock) noexcept : wire_(std::move(wire)), clock_(clock) {}

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override {
    wire_->write(frame.payload());
    return SendResult::kQueued;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    if (waiting_.empty() && wire_->has_peer()) waiting_ = wire_->read();
    if (waiting_.empty()) return false;
    received = {first_frame(waiting_), clock_.now()};
    return true;
  }
  [[nodiscard]] CanHealth health() const noexcept override { return {}; }
  [[nodiscard]] ByteServer& wire() noexcept { return *wire_; }

 private:
  std::unique_ptr<ByteServer> wire_;
  Clock& clock_;
  wire::Bytes waiting_;
};

}  // namespace jaywalk::emulators
