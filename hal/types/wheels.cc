#include "hal/types/wheels.h"

#include <array>

namespace jaywalk {

std::string_view name(DriveTrouble trouble) noexcept {
  constexpr std::array<std::string_view, 8> kNames{
      "none",           "bus takes no frames", "bus unwell",      "drive's emergency message",
      "drive in fault", "drive silent",        "drive restarted", "drive left operation"};
  const auto index = static_cast<std::size_t>(trouble);
  return index < kNames.size() ? kNames[index] : "unknown trouble";
}

}  // namespace jaywalk
