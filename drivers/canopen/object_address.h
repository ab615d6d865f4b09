#pragma once
#include <compare>
#include <cstdint>

namespace jaywalk::canopen {

/// Where a value lives in a device's object dictionary.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  auto operator<=>(const ObjectAddress&) const = default;
};

}  // namespace jaywalk::canopen
