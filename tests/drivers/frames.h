#pragma once
#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <ostream>

#include "drivers/can/can_bus.h"

namespace jaywalk {

/// For failed checks.
inline std::ostream& operator<<(std::ostream& out, const CanFrame& frame) {
  out << std::hex << frame.id << (frame.extended ? "x" : "") << (frame.remote ? " remote" : "") << " #";
  for (const std::uint8_t byte : frame.payload()) out << ' ' << static_cast<int>(byte);
  return out << std::dec;
}

namespace tests {

/// A frame as one writes it: identifier, bytes.
inline CanFrame frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  CanFrame made;
  made.id = id;
  made.size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), made.bytes.begin());
  return made;
}

/// The same with an identifier of 29 bits.
inline CanFrame extended(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  CanFrame made = frame(id, bytes);
  made.extended = true;
  return made;
}

}  // namespace tests
}  // namespace jaywalk
