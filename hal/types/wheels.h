#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "hal/types/errors.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Why a drive base on wires stopped its wheels by itself; it stays so until a person's reset.
enum class DriveTrouble : std::uint8_t {
  kNone,
  kBusRefused,       ///< a frame was not taken
  kBusUnwell,        ///< error passive, bus-off, interface down
  kEmergency,        ///< a drive sent an emergency message
  kDriveFault,       ///< a drive says that it is in fault
  kDriveSilent,      ///< a drive says nothing
  kDriveRestarted,   ///< a drive that was set up is so no more
  kLeftOperation,    ///< a drive that was enabled is so no more, unasked
  kNotOperational,   ///< a drive left the network state in which it takes setpoints
  kForeignMaster,    ///< another program commands the drives, or speaks with the controller's number
  kStopUnconfirmed,  ///< a stop that both wheels' feedback does not show in time
  kNotProved         ///< a drive did not pass its arming proof again after a reset
};
/// The last of them, for checks of what is read.
inline constexpr DriveTrouble kLastDriveTrouble = DriveTrouble::kNotProved;

/// "drive silent".
[[nodiscard]] inline std::string_view name(DriveTrouble trouble) noexcept {
  constexpr std::array<std::string_view, 12> kNames{"none",
                                                    "bus takes no frames",
                                                    "bus unwell",
                                                    "drive's emergency message",
                                                    "drive in fault",
                                                    "drive silent",
                                                    "drive restarted",
                                                    "drive left operation",
                                                    "drive not operational",
                                                    "another master on the bus",
                                                    "stop not confirmed",
                                                    "drive not proved again"};
  const auto index = static_cast<std::size_t>(trouble);
  return index < kNames.size() ? kNames[index] : "unknown trouble";
}

/// How far a stop has had to go because the wheels' feedback did not confirm it (SAFETY 14).
enum class StopStage : std::uint8_t {
  kNone,         ///< no stop is under way, or it is confirmed so far
  kQuickStop,    ///< the drives are told to brake by themselves
  kNetworkStop,  ///< NMT stop, or what else the drive has that ends its obedience
  kSilent        ///< nothing is sent any more, no heartbeat either: the drives' own watchdogs act
};

/// "quick stop".
[[nodiscard]] inline std::string_view name(StopStage stage) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"none", "quick stop", "network stop", "silent"};
  const auto index = static_cast<std::size_t>(stage);
  return index < kNames.size() ? kNames[index] : "unknown stage";
}

/// What the wheel encoders say; the two wheels of a differential drive.
struct WheelState {
  Time stamp = kNever;
  /// Grows by one a reading; 0: none yet. Begins anew at 1 where the angles do not go on from the reading before.
  std::uint32_t sequence = 0;
  double left_rad = 0.0;  ///< angle turned since start; forward is positive; never wraps
  double right_rad = 0.0;
  double left_radps = 0.0;
  double right_radps = 0.0;
  DriveTrouble trouble = DriveTrouble::kNone;
  DriveFault fault = {};  ///< what a drive tells of it
  StopStage stop = StopStage::kNone;
  bool ready = true;  ///< both drives follow commands; of drives on wires: proved, enabled, and without trouble
};

/// What the wheels are asked to do.
struct WheelCommand {
  Time stamp = kNever;
  double left_radps = 0.0;
  double right_radps = 0.0;
};

/// Below these speeds the robot is at rest: more than encoders scatter by, less than any drive is asked for.
inline constexpr double kAtRest_mps = 0.01, kAtRest_radps = 0.02;

[[nodiscard]] inline bool is_at_rest(const Twist2& twist) {
  return std::fabs(twist.v_mps) < kAtRest_mps && std::fabs(twist.w_radps) < kAtRest_radps;
}

}  // namespace jaywalk
