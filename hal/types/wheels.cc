#include "hal/types/wheels.h"

#include <array>

namespace jaywalk {

std::string_view name(DriveTrouble trouble) noexcept {
  constexpr std::array<std::string_view, 12> kNames{"none",
                                                    "bus takes no frames",
                                                    "bus unwell",
                                                    "drive's emergency message",
                                                    "drive in fault",
                                                    "drive silent",
                                                    "drive restarted",
                                                    "drive left operation",
                                                    "drive not operational",
                                                    "another master on the bus",
                                                    "stop not confirmed",
                                                    "drive not proved again"};
  const auto index = static_cast<std::size_t>(trouble);
  return index < kNames.size() ? kNames[index] : "unknown trouble";
}

std::string_view name(StopStage stage) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"none", "quick stop", "network stop", "silent"};
  const auto index = static_cast<std::size_t>(stage);
  return index < kNames.size() ? kNames[index] : "unknown stage";
}

}  // namespace jaywalk
