#pragma once
#include <cstdint>

namespace jaywalk::canopen {

/// Where a value lives in a device's object dictionary.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  bool operator==(const ObjectAddress&) const = default;
  constexpr bool operator<(const ObjectAddress& other) const {
    return index != other.index ? index < other.index : sub < other.sub;
  }
};

}  // namespace jaywalk::canopen
