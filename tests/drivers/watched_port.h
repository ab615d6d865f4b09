#pragma once
#include <cstdint>

#include "drivers/can/can_bus.h"
#include "hal/hal.h"

namespace jaywalk::tests {

/// The controller's place on the bus: counts what it sends, and can be made not to hear one identifier.
class WatchedPort final : public CanBus {
 public:
  WatchedPort(CanBus& bus, Clock& clock) noexcept : bus_(bus), clock_(clock) {}
  [[nodiscard]] bool send(const CanFrame& frame) noexcept override {
    ++sent_;
    last_ = clock_.now();
    return bus_.send(frame);
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    while (bus_.receive(received)) {
      if (received.frame.id != deaf_to_) return true;
    }
    return false;
  }
  [[nodiscard]] CanHealth health() const noexcept override { return bus_.health(); }
  void become_deaf_to(std::uint32_t id) noexcept { deaf_to_ = id; }
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
  [[nodiscard]] Time last() const noexcept { return last_; }

 private:
  CanBus& bus_;
  Clock& clock_;
  std::uint32_t deaf_to_ = 0xFFFFFFFF;
  std::uint64_t sent_ = 0;
  Time last_ = kNever;
};

}  // namespace jaywalk::tests
