#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/motor/motor_pair.h"
#include "drivers/motor/vesc.h"

namespace jaywalk::vesc {

struct BaseSetup {
  std::array<CanAxis, 2> axes;  ///< left, right: electrical turns a radian of the wheel
  std::uint8_t own = 254;       ///< CAN identifier of this program, to which the controllers answer
  /// Shortest and longest timeout that a controller may be set to: it must outlast two commands, and a controller looks
  /// at its timeout every 10 ms.
  Duration timeout_least = std::chrono::milliseconds(40), timeout_most = std::chrono::milliseconds(90);
  Duration silence_limit = std::chrono::milliseconds(150);  ///< without status message 9
  Duration settling = std::chrono::milliseconds(300);
  StopLimits stop;              ///< braking and tolerance must be given
  bool allow_unproved = false;  ///< arms although a controller is not set to stop by itself
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
  /// A VESC forgets a fault by itself after a time.
  void send_reset(std::size_t) noexcept override {}
  void begin_proof(std::size_t index) noexcept override;
  ProofResult continue_proof(std::size_t index) noexcept override;
  [[nodiscard]] bool is_proved_by(const StopSettings& settings) const noexcept;
  [[nodiscard]] std::string proof_line(std::size_t index) const override;
  [[nodiscard]] std::string proof_remedy(std::size_t index) const override;
  [[nodiscard]] StartupError absence(std::size_t index) const override;
  [[nodiscard]] std::string who(std::size_t index) const;

  BaseSetup setup_;
  std::array<Seen, 2> seen_;
  SettingsReader reader_;
};

}  // namespace jaywalk::vesc
