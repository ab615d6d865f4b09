#pragma once
// VESC's CAN messages: 29-bit identifier command * 256 + controller, numbers most significant byte first.
#include <cstdint>
#include <optional>
#include <variant>

#include "drivers/can/can_frame.h"

namespace jaywalk::vesc {

/// Electrical turns a minute: the motor's times its pole pairs.
[[nodiscard]] CanFrame set_erpm(std::uint8_t controller, std::int32_t erpm) noexcept;
/// Motor current; 0 lets it roll.
[[nodiscard]] CanFrame set_current(std::uint8_t controller, std::int32_t milliampere) noexcept;
/// Current that brakes; 0 lets it roll.
[[nodiscard]] CanFrame set_brake_current(std::uint8_t controller, std::int32_t milliampere) noexcept;

struct Status {  ///< message 9
  std::int32_t erpm = 0;
  double current_a = 0.0;
  double duty = 0.0;  ///< -1 to 1
};

struct Temperatures {  ///< message 16
  double fet_celsius = 0.0;
  double motor_celsius = 0.0;
  double input_current_a = 0.0;
};

struct Travel {                                ///< message 27
  std::int32_t sixths_of_electrical_turn = 0;  ///< wraps
  double input_v = 0.0;
};

struct Message {
  std::uint8_t controller = 0;
  std::variant<Status, Temperatures, Travel> content;
};

/// Nothing where `frame` is none of these or is too short.
[[nodiscard]] std::optional<Message> decode(const CanFrame& frame) noexcept;

}  // namespace jaywalk::vesc
