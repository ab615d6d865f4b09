#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/motor/motor_pair.h"
#include "drivers/motor/vesc.h"

namespace jaywalk::vesc {

struct AxisSetup {
  std::uint8_t controller = 0;
  /// Electrical turns of the motor to a radian of the wheel: pole pairs times gear ratio over 2 pi; negative where it
  /// is mounted the other way round.
  double electrical_turns_per_rad = 0.0;
};

struct BaseSetup {
  std::array<AxisSetup, 2> axes;  ///< left, right
  std::uint8_t own = 254;         ///< whom the controllers answer
  /// Shortest and longest timeout that a controller may be set to: it must outlast two commands, and a controller looks
  /// at its timeout every 10 ms.
  Duration timeout_least = std::chrono::milliseconds(40), timeout_most = std::chrono::milliseconds(90);
  Duration silence_limit = std::chrono::milliseconds(150);  ///< without status message 9
  Duration settling = std::chrono::milliseconds(300);
  bool allow_unproved = false;  ///< arms although a controller is not set to stop by itself
};

/// Two VESCs that take electrical speeds.
///
/// Arming proof: each controller's settings are read back and must hold a timeout within the limit and a current that
/// brakes when it has run out. That is what it was told, not what it does; a VESC cannot be made to show that. They
/// must send status messages 1 and 5 (numbers 9 and 27) by themselves, and tell their fault code when asked, once a
/// command. A VESC has no state that says "enabled": it obeys while it speaks, has no fault, and was armed.
class VescBase final : public MotorPair {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  VescBase(CanBus& bus, Clock& clock, const BaseSetup& setup);
  std::vector<std::string> arm() override;
  [[nodiscard]] std::string inspect(std::size_t side) override;

 private:
  struct Seen {
    std::optional<StopSettings> settings;
    bool answered = false;  ///< with settings, good or not
    bool has_travel = false;
    std::uint32_t travel = 0;
    std::int64_t sixths = 0;  ///< of an electrical turn, since start
    std::uint8_t fault = 0;
    bool torque_on = false;  ///< it was told to follow speeds
  };

  void take(const ReceivedFrame& received) noexcept override;
  void take_own(std::size_t index, const Message& message, Time stamp) noexcept;
  void take_answer(const Message& message) noexcept;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  /// A VESC forgets a fault by itself after a time.
  void send_reset(std::size_t) noexcept override {}

  void await_messages(std::size_t index);
  /// The proof's line. Throws StartupError where it was none and has to be one.
  [[nodiscard]] std::string proof_of(std::size_t index);
  [[nodiscard]] bool prove_timeout(std::size_t index, std::string& line);
  [[nodiscard]] std::string who(std::size_t index) const;

  BaseSetup setup_;
  std::array<Seen, 2> seen_;
  SettingsReader reader_;
};

/// Tells two controllers to stand still, over a place of its own on their bus.
class Stopper final : public EmergencyBrake {
 public:
  /// `bus` outlives it and belongs to the thread that brakes.
  Stopper(CanBus& bus, std::array<std::uint8_t, 2> controllers) noexcept : bus_(bus), controllers_(controllers) {}
  void brake() noexcept override;

 private:
  CanBus& bus_;
  std::array<std::uint8_t, 2> controllers_;
};

}  // namespace jaywalk::vesc
