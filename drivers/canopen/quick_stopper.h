#pragma once
#include <array>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/pdo.h"
#include "drivers/wired_drive.h"

namespace jaywalk::canopen {

/// Tells two CiA 402 drives to quick-stop, over a place of its own on their bus.
class QuickStopper final : public EmergencyBrake {
 public:
  /// `bus` outlives it and belongs to the thread that brakes. The drives are set up as CanopenDriveBase does.
  QuickStopper(CanBus& bus, std::array<std::uint8_t, 2> nodes) noexcept;
  void brake() noexcept override;

 private:
  CanBus& bus_;
  std::array<std::uint8_t, 2> nodes_;
  std::array<PdoMapping, 2> mappings_;
};

}  // namespace jaywalk::canopen
