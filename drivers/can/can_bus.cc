#include "drivers/can/can_bus.h"

#include <cstdio>

namespace jaywalk {

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

}  // namespace jaywalk
