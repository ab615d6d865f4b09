#pragma once
// VESC's CAN messages: 29-bit identifier command * 256 + controller, numbers most significant byte first.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "drivers/can/can_bus.h"

namespace jaywalk::vesc {

/// Electrical turns a minute: the motor's times its pole pairs.
[[nodiscard]] CanFrame set_erpm(std::uint8_t controller, std::int32_t erpm) noexcept;
/// Motor current; 0 lets it roll.
[[nodiscard]] CanFrame set_current(std::uint8_t controller, std::int32_t milliampere) noexcept;
/// Current that brakes; 0 lets it roll.
[[nodiscard]] CanFrame set_brake_current(std::uint8_t controller, std::int32_t milliampere) noexcept;

/// Asks for the application's settings, which come in many frames to `own`.
[[nodiscard]] CanFrame ask_settings(std::uint8_t controller, std::uint8_t own) noexcept;
/// Asks for the fault code alone; the answer fits into one frame to `own`.
[[nodiscard]] CanFrame ask_fault(std::uint8_t controller, std::uint8_t own) noexcept;
/// CRC-16 with polynomial 1021h from 0, highest bit first, over long messages.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes) noexcept;

struct Status {  ///< message 9
  std::int32_t erpm = 0;
};

struct Travel {                                ///< message 27
  std::int32_t sixths_of_electrical_turn = 0;  ///< wraps
};

/// A piece of a long message to `Message::controller`: messages 5 and 6.
struct Piece {
  std::uint16_t offset = 0;
  std::uint8_t size = 0;
  std::array<std::uint8_t, 7> bytes{};
};

struct PiecesEnd {  ///< message 7: all pieces were sent
  std::uint8_t from = 0;
  std::uint16_t size = 0;
  std::uint16_t crc = 0;
};

struct Fault {  ///< message 8 with the answer to ask_fault
  std::uint8_t from = 0;
  std::uint8_t code = 0;  ///< 0: none
};

struct Message {
  std::uint8_t controller = 0;  ///< sender; of the last three kinds, receiver
  std::variant<Status, Travel, Piece, PiecesEnd, Fault> content;
};

/// Whether `frame` is one that only a controller sends to `controller` or to all (255): what sets something, a
/// question, a ping, or a piece of a long message.
[[nodiscard]] bool is_order(const CanFrame& frame, std::uint8_t controller) noexcept;

/// Nothing where `frame` is none of these or is too short.
[[nodiscard]] std::optional<Message> decode(const CanFrame& frame) noexcept;

/// What of a VESC's settings decides how it stops when nobody speaks to it.
struct StopSettings {
  std::uint32_t timeout_ms = 0;  ///< 0: never
  double brake_current_a = 0.0;  ///< 0: it rolls out
};

/// Puts the pieces of the answer to ask_settings together.
class SettingsReader {
 public:
  static constexpr std::size_t kMost = 512;  ///< the firmware's longest message

  void begin() noexcept { filled_ = 0; }
  void take(const Piece& piece) noexcept;
  /// The settings, where all bytes came and hold together; firmware 3.0 and newer.
  [[nodiscard]] std::optional<StopSettings> finish(const PiecesEnd& end) const noexcept;

 private:
  std::array<std::uint8_t, kMost> bytes_{};
  std::size_t filled_ = 0;  ///< bytes from the first on without a gap
};

}  // namespace jaywalk::vesc
