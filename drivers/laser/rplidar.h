#pragma once
// Slamtec's RPLIDAR A series on a serial line: requests A5h and a command, answers A5h 5Ah and their length and type.
#include <array>
#include <cstdint>
#include <optional>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::rplidar {

inline constexpr std::array<std::uint8_t, 2> kStopRequest{0xA5, 0x25}, kScanRequest{0xA5, 0x20};
/// The motor on at 660 of 1023, as the maker's own software has it, and the question how the scanner is.
inline constexpr std::array<std::uint8_t, 8> kMotorOnAndHealth{0xA5, 0xF0, 0x02, 0x94, 0x02, 0xC1, 0xA5, 0x52};

/// What introduces an answer.
struct Descriptor {
  std::uint32_t bytes = 0;  ///< of each part of the answer
  bool repeats = false;     ///< part follows part until it is stopped
  std::uint8_t type = 0;
  bool operator==(const Descriptor&) const = default;
};

inline constexpr std::size_t kDescriptorBytes = 7, kNodeBytes = 5, kHealthBytes = 3;
inline constexpr Descriptor kHealthComes{kHealthBytes, false, 0x06}, kNodesCome{kNodeBytes, true, 0x81};

/// Nothing where the bytes are fewer or do not begin with A5h 5Ah.
[[nodiscard]] std::optional<Descriptor> decode_descriptor(wire::Bytes bytes) noexcept;

/// One measured point.
struct Node {
  bool begins_turn = false;
  std::uint8_t quality = 0;
  double angle_deg = 0.0;  ///< clockwise from ahead, below 360
  float range_m = 0.0F;    ///< 0: the measurement is not valid
};

/// Nothing where the bytes are fewer, their check bits wrong, or the angle more than a turn and 10 degrees.
[[nodiscard]] std::optional<Node> decode_node(wire::Bytes bytes) noexcept;

}  // namespace jaywalk::rplidar
