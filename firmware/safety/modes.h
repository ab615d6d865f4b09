#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace jaywalk {

/// What the robot does, as far as safety is concerned.
enum class Mode : std::uint8_t {
  kOff,       ///< no loop runs
  kStandby,   ///< the drives are not ready: not proved yet, or proved anew after a reset
  kArmed,     ///< ready, at rest, without a goal
  kDriving,   ///< on the way to a goal
  kTurning,   ///< at the goal, on the way to the heading wanted there
  kStopping,  ///< ramps to rest: the goal is gone, or a fault that ends by itself is there
  kLatched    ///< a fault happened: at rest until a person's reset
};

/// What the loop lets out to the drives in a mode.
enum class WireOrder : std::uint8_t {
  kNothing,    ///< no frame: the drives' own watchdogs hold the wheels
  kZero,       ///< heartbeat and setpoints of zero; no torque until the drives are proved
  kSetpoints,  ///< heartbeat and the permitted speeds
  kRamp        ///< heartbeat and speeds that only fall
};

struct ModeRow {
  Mode mode;
  std::string_view name;
  WireOrder wire;
};

/// One row a mode, in the order of Mode.
inline constexpr std::array kModes{
    ModeRow{Mode::kOff, "off", WireOrder::kNothing},
    ModeRow{Mode::kStandby, "standby", WireOrder::kZero},  // and the arming proof; no torque
    ModeRow{Mode::kArmed, "armed", WireOrder::kZero},      // torque holds the wheels
    ModeRow{Mode::kDriving, "driving", WireOrder::kSetpoints},
    ModeRow{Mode::kTurning, "turning", WireOrder::kSetpoints},
    ModeRow{Mode::kStopping, "stopping", WireOrder::kRamp},
    // Where the feedback does not confirm the ramp: quick stop, network stop, then no frame.
    ModeRow{Mode::kLatched, "latched", WireOrder::kRamp},
};

[[nodiscard]] constexpr const ModeRow& row_of(Mode mode) noexcept { return kModes[static_cast<std::size_t>(mode)]; }

/// What decides about the next mode, in one tick.
struct ModeInput {
  bool fault = false;         ///< one is there now
  bool latches = false;       ///< and it waits for a reset when it is gone
  bool stop_pressed = false;  ///< the emergency stop's button, now
  bool reset_edge = false;    ///< a person's reset, its rising edge
  bool wants_zero = false;    ///< the wanted twist is zero, and a stick in its middle
  bool drives_ready = false;  ///< both proved and enabled, without trouble
  bool has_goal = false;      ///< or a stick that is not in its middle
  bool at_goal = false;       ///< where only the heading is left to be reached
  bool at_rest = false;       ///< nothing is permitted any more, that is: the ramp has ended
};

/// The mode after this tick's input. Latched is left by a reset's edge with the button released and a wanted twist of
/// zero, to standby, or to armed where the drives are ready; standby is left when the drives are ready and the wanted
/// twist is zero: there is no other way from a fault to motion. A fault that is still there latches again.
[[nodiscard]] constexpr Mode next_mode(Mode mode, const ModeInput& in) noexcept {
  const bool may_leave = in.reset_edge && in.wants_zero && !in.stop_pressed;
  if (in.latches && !(mode == Mode::kLatched && may_leave)) return Mode::kLatched;
  if (mode == Mode::kLatched && !may_leave) return Mode::kLatched;
  if (!in.drives_ready || (mode == Mode::kLatched && in.latches)) return Mode::kStandby;
  if ((mode == Mode::kOff || mode == Mode::kStandby) && !in.wants_zero) return Mode::kStandby;
  if (mode == Mode::kLatched) return Mode::kArmed;
  if (in.fault) return in.at_rest ? Mode::kArmed : Mode::kStopping;
  if (in.has_goal) return in.at_goal ? Mode::kTurning : Mode::kDriving;
  return in.at_rest ? Mode::kArmed : Mode::kStopping;
}

}  // namespace jaywalk
