#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "drivers/motor/motor_pair.h"
#include "drivers/motor/odrive.h"
#include "drivers/wired_drive.h"

namespace jaywalk::odrive {

struct BaseSetup {
  std::array<CanAxis, 2> axes;  ///< left, right: turns of the motor a radian of the wheel
  /// A watchdog that did not show itself so long after the last command is not proved. The heartbeat that shows it adds
  /// to what the watchdog takes: heartbeat_msg_rate_ms of 10 and watchdog_timeout of 0.06 fit.
  Duration watchdog_limit = std::chrono::milliseconds(100);
  Duration watchdog_least = std::chrono::milliseconds(40);  ///< it must outlast two commands
  Duration silence_limit = std::chrono::milliseconds(150);  ///< without a heartbeat
  /// An axis is set to say it no more often (heartbeat_msg_rate_ms); more are a second axis with its number.
  Duration heartbeat_least = std::chrono::milliseconds(10);
  Duration settling = std::chrono::milliseconds(300);
  StopLimits stop;              ///< braking and tolerance must be given
  bool allow_unproved = false;  ///< arms although an axis did not show that it stops by itself
};

/// Two axes of ODrives of firmware 0.6 in velocity control, ramped by their own vel_ramp_rate.
///
/// Arming proof: WatchdogProof, of one axis after the other, before the first command and after every return. An
/// ODrive does not brake its wheel when its watchdog expires or when it is set idle: the wheel coasts.
class OdriveBase final : public MotorPair {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  OdriveBase(CanBus& bus, Clock& clock, const BaseSetup& setup);
  [[nodiscard]] std::string inspect(std::size_t side) override;

 private:
  struct Seen {
    std::uint32_t errors = 0;
    std::uint8_t state = 0;  ///< AxisState where it is one of those
    std::uint8_t procedure = 0;
    Time expired = kNever;  ///< its watchdog, by its heartbeats
    FrameRate heartbeats = {};
    float position_turns = 0.0F;
  };

  void take(const ReceivedFrame& received) noexcept override;
  void take_heartbeat(std::size_t index, const Heartbeat& heartbeat, Time stamp) noexcept;
  void take_estimates(std::size_t index, const EncoderEstimates& estimates, Time stamp) noexcept;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  void send_reset(std::size_t index) noexcept override;
  void begin_proof(std::size_t index) noexcept override;
  ProofResult continue_proof(std::size_t index) noexcept override;
  [[nodiscard]] std::string proof_line(std::size_t index) const override;
  [[nodiscard]] std::string proof_remedy(std::size_t index) const override;
  [[nodiscard]] StartupError absence(std::size_t index) const override;
  [[nodiscard]] std::string who(std::size_t index) const;

  BaseSetup setup_;
  std::array<Seen, 2> seen_;
  std::array<WatchdogProof, 2> proofs_;
};

}  // namespace jaywalk::odrive
