#pragma once
// VESC's CAN messages: 29-bit identifier command * 256 + controller, numbers most significant byte first.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "drivers/can/can_bus.h"
#include "drivers/motor/motor_pair.h"

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
[[nodiscard]] std::uint16_t crc16(wire::Bytes bytes) noexcept;

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

struct BaseSetup {
  std::array<CanAxis, 2> axes;  ///< left, right: electrical turns a radian of the wheel
  std::uint8_t own = 254;       ///< CAN identifier of this program, to which the controllers answer
  /// Shortest and longest timeout that a controller may be set to: it must outlast two commands, and a controller looks
  /// at its timeout every 10 ms.
  Duration timeout_least = std::chrono::milliseconds(40), timeout_most = std::chrono::milliseconds(90);
  Duration silence_limit = std::chrono::milliseconds(150);  ///< without status message 9
  StopLimits stop;                                          ///< braking and tolerance must be given
  bool allow_unproved = false;                              ///< arms although a controller is not set to stop by itself
};

/// Two VESCs that take electrical speeds.
///
/// Arming proof, before the first command and after every return: each controller's settings are read back and must
/// hold a timeout within the limit and a current that brakes when it has run out. That is what it was told, not what it
/// does; a VESC cannot be made to show that. They must send status messages 1 and 5 (numbers 9 and 27) by themselves,
/// and tell their fault code when asked, once a command. A VESC has no state that says "enabled": it obeys while it
/// speaks, has no fault, and was armed. Told less than its minimum ERPM it lets its motor go; where that stands among
/// its settings differs from firmware to firmware, so it is not read back. One that does not obey speed zero is told to
/// brake with the current that was read back.
class VescBase final : public MotorPair {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  VescBase(CanBus& bus, Clock& clock, const BaseSetup& setup);

 private:
  struct Seen {
    std::optional<StopSettings> settings;
    Time asked = kNever;    ///< for its settings
    bool answered = false;  ///< with settings, good or not
    std::uint32_t travel = 0;
    std::uint32_t open_asks = 0;  ///< for its fault code, without an answer so far
    std::uint8_t fault = 0;
    bool torque_on = false;  ///< it was told to follow speeds
    // Since its motor turned last.
    std::uint32_t stood_at = 0;  ///< travel
    double told_turns = 0.0;     ///< electrical
    Time told = kNever;
  };

  void take(const ReceivedFrame& received) noexcept override;
  void take_own(std::size_t index, const Message& message, Time stamp) noexcept;
  /// False for an answer that the controller did not ask for.
  [[nodiscard]] bool take_answer(const Message& message, Time stamp) noexcept;
  [[nodiscard]] bool take_fault(const Fault& fault) noexcept;
  [[nodiscard]] bool is_awaited(std::size_t index, Time stamp) const noexcept;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  void ask_for_fault(std::size_t index) noexcept;
  /// Its motor is told to turn: one that does not is below its minimum ERPM, or blocked.
  void hold_to_speed(std::size_t index, bool runs, std::int32_t erpm) noexcept;
  void begin_proof(std::size_t index) noexcept override;
  ProofResult continue_proof(std::size_t index) noexcept override;
  [[nodiscard]] bool is_proved_by(const StopSettings& settings) const noexcept;
  [[nodiscard]] std::string proof_line(std::size_t index) const override;
  [[nodiscard]] std::string proof_remedy(std::size_t index) const override;
  [[nodiscard]] StartupError absence(std::size_t index) const override;
  [[nodiscard]] std::string who(std::size_t index) const {
    return "VESC " + std::to_string(setup_.axes[index].node) + ": ";
  }

  BaseSetup setup_;
  std::array<Seen, 2> seen_;
  SettingsReader reader_;
};

}  // namespace jaywalk::vesc
