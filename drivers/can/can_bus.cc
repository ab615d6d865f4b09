#include "drivers/can/can_bus.h"

namespace jaywalk {

std::string_view name(CanState state) noexcept {
  switch (state) {
    case CanState::kActive:
      return "error active";
    case CanState::kWarning:
      return "error warning";
    case CanState::kPassive:
      return "error passive";
    case CanState::kBusOff:
      return "bus-off";
    case CanState::kDown:
      return "interface down";
  }
  return "unknown state";
}

std::string_view name(SendResult result) noexcept {
  switch (result) {
    case SendResult::kQueued:
      return "queued";
    case SendResult::kQueueFull:
      return "send queue full";
    case SendResult::kOffBus:
      return "off the bus";
    case SendResult::kNotAFrame:
      return "not a frame";
    case SendResult::kSystemError:
      return "refused by the system";
  }
  return "unknown result";
}

}  // namespace jaywalk
