#pragma once
#include "drivers/can/can_bus.h"
#include "drivers/ros/ring_messages.h"
#include "hal/hal.h"

namespace jaywalk::ros {

/// A ROS base as a bus with two motors: frames to and from jaywalk_dds through a shared ring each way. Frames that are
/// torn, unknown or of another time are counted as malformed. Thread: one, and any for brake().
class RosBus final : public CanBus {
 public:
  struct Rings {
    std::filesystem::path states, orders;
  };
  /// Makes both rings. `clock` outlives it. Throws StartupError.
  RosBus(const Rings& rings, Clock& clock)
      : states_(SharedRing::make(rings.states, kBaseRing)),
        orders_(SharedRing::make(rings.orders, kBaseRing)),
        clock_(clock) {}

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  [[nodiscard]] CanHealth health() const noexcept override;
  /// Has jaywalk_dds command zero at once.
  void brake() noexcept { orders_->raise_alarm(); }

 private:
  std::unique_ptr<SharedRing> states_, orders_;
  Clock& clock_;
  std::uint64_t malformed_ = 0;
};

}  // namespace jaywalk::ros
