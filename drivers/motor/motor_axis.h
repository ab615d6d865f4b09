#pragma once
#include <cstdint>

#include "hal/types/time.h"

namespace jaywalk {

/// What one motor is told in a cycle.
enum class MotorOrder : std::uint8_t {
  kOff,         ///< no torque
  kHold,        ///< torque on, speed zero
  kRun,         ///< follow the speed
  kStop,        ///< speed zero because of trouble; nothing else that changes its state
  kNetworkStop  ///< what else the motor has that ends its obedience, where it does not obey speed zero
};

/// How the arming proof of one motor stands.
enum class ProofResult : std::uint8_t {
  kUnderWay,
  kPassed,
  kUnproved,  ///< it did not show that it stops by itself; all else is well
  kFailed,
  kAbsent  ///< it does not show itself
};

/// What is known of one motor, in the wheel's units.
struct MotorAxis {
  double turned_rad = 0.0;  ///< since start; goes on where a motor comes back
  double speed_radps = 0.0;
  bool fresh_position = false, fresh_speed = false;
  bool obeys = false;        ///< its torque is on and it follows speeds
  bool was_enabled = false;  ///< and was asked to
  Time heard = kNever;       ///< of the message that it always sends; kNever: not since its proof began
  Time felt = kNever;        ///< of the last speed; likewise
  Time placed = kNever;      ///< of the last position; likewise
  bool silenced = false;     ///< it is told nothing more until a reset

  /// All that it has to send by itself came since its proof began.
  [[nodiscard]] bool shows_itself() const noexcept { return heard != kNever && felt != kNever && placed != kNever; }
  /// Its proof begins: what it said before counts no more.
  void forget() noexcept {
    fresh_position = fresh_speed = obeys = was_enabled = false;
    heard = felt = placed = kNever;
  }
};

}  // namespace jaywalk
