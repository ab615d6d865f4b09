#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "hal/types/time.h"

namespace jaywalk {

/// A classic CAN frame (ISO 11898-1): up to 8 bytes under an identifier of 11 bits, or 29 where `extended`.
struct CanFrame {
  std::uint32_t id = 0;
  bool extended = false;
  bool remote = false;    ///< asks for a frame of `size` bytes instead of carrying them
  std::uint8_t size = 0;  ///< bytes in use, at most 8; the others are 0
  std::array<std::uint8_t, 8> bytes{};

  [[nodiscard]] std::span<const std::uint8_t> payload() const noexcept { return {bytes.data(), size}; }
  bool operator==(const CanFrame&) const = default;
};

/// "701#05", as candump has it. Not for the loop.
[[nodiscard]] std::string to_text(const CanFrame& frame);

inline constexpr std::uint32_t kMaxStandardId = 0x7FF, kMaxExtendedId = 0x1FFFFFFF;

/// True for what can stand on a bus: identifier and size within their ranges.
[[nodiscard]] constexpr bool is_valid(const CanFrame& frame) noexcept {
  return frame.size <= 8 && frame.id <= (frame.extended ? kMaxExtendedId : kMaxStandardId);
}

/// A frame and when it came in (the kernel's stamp where there is one).
struct ReceivedFrame {
  CanFrame frame;
  Time stamp = kNever;
};

}  // namespace jaywalk
