#pragma once
#include <array>
#include <limits>

#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// What a stop is held against. Speeds are the wheels', rad/s.
struct StopLimits {
  double brake_radps2 = 0.0;     ///< the ramp that a stop is owed; the drives were shown to be set to it or more
  double tolerance_radps = 0.0;  ///< a wheel may be so much faster than its ramp; below it, it stands
  Duration response = std::chrono::milliseconds(60);       ///< from the order until the ramp must show in the feedback
  Duration stage = std::chrono::milliseconds(20);          ///< from one stage to the next
  Duration fresh = std::chrono::milliseconds(60);          ///< older feedback confirms nothing
  Duration tick = std::chrono::milliseconds(20);           ///< the controller's cycle
  Duration confirmation = std::chrono::milliseconds(100);  ///< after the ramp's end both wheels show that they stand
};

/// As much time as the loop's period `tick` makes of it, since the feedback that a tick reads was measured a period
/// before. One late tick is no stop. A drive that states that it obeys or reports slower than usual has that time too.
[[nodiscard]] StopLimits stop_limits(double brake_radps2, double tolerance_radps, Duration tick,
                                     const DriveTimes& drive = {}) noexcept;

/// What one wheel's drive said last, and what it is told in this cycle.
struct WheelFeedback {
  double speed_radps = 0.0;
  Time stamp = kNever;
  double told_radps = std::numeric_limits<double>::infinity();  ///< infinity: not known
};

/// Follows a stop until both wheels' feedback confirms it, and says how far it must go where they do not (SAFETY 14).
///
/// From the order on each wheel must stay below v - b (t - response), v its speed at the order, and say so with fresh
/// feedback. Where it was told to slow down before, v is at most what that left of it at the ramp b: a commanded ramp
/// is not owed twice. One that does not takes the stop a stage further: quick stop, network stop, silence, one `stage`
/// after the other. `confirmation` after the ramp both wheels stand or nothing is sent any more, whatever the loop's
/// rate: a stage for which no cycle is left until then comes together with the next, or not at all. A stage is never
/// gone back on before reset().
///
/// A stop that was commanded (both speeds zero) ends when both wheels stand; one because of trouble is watched until
/// reset(): a wheel that turns again while the drives are in trouble takes it further. Thread: the drive base's; never
/// allocates.
class StopLadder {
 public:
  explicit StopLadder(const StopLimits& limits) noexcept : limits_(limits) {}

  /// Once a cycle, before what the drives are told. `stopping`: the command is zero for both wheels, or there is
  /// trouble. `trouble`: the drives were told to quick-stop. Left, right.
  [[nodiscard]] StopStage update(Time now, bool stopping, bool trouble,
                                 const std::array<WheelFeedback, 2>& wheels) noexcept;
  [[nodiscard]] StopStage stage() const noexcept { return stage_; }
  /// A person's reset edge: the next stop begins anew.
  void reset() noexcept;

 private:
  /// What each wheel was told, falling with the ramp at most.
  void follow_orders(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept;
  void begin(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept;
  [[nodiscard]] bool is_over(Time now) const noexcept;
  /// Whether the feedback shows what the ramp allows now.
  [[nodiscard]] bool is_kept(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept;
  [[nodiscard]] bool is_at_rest(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept;
  [[nodiscard]] bool is_fresh(Time now, const WheelFeedback& wheel) const noexcept;
  void climb(Time now) noexcept;

  StopLimits limits_;
  StopStage stage_ = StopStage::kNone;
  bool under_way_ = false, ended_ = false;
  bool trouble_ = false;
  Time ordered_ = kNever, climbed_ = kNever;
  double longest_s_ = 0.0;  ///< of this stop: nothing is sent later to wheels that do not stand
  bool confirmed_ = false;  ///< they stood then
  Time followed_ = kNever;
  std::array<double, 2> told_radps_{}, owed_radps_{}, speed_at_order_{};
};

}  // namespace jaywalk
