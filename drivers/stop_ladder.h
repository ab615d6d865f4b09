#pragma once
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

/// Follows a wheel's stop until its feedback confirms it, and says how far it must go where that does not (SAFETY 14).
///
/// From the order on the wheel must stay below v - b (t - response), v its speed at the order, and say so with fresh
/// feedback. Where it was told to slow down before, v is at most what that left of it at the ramp b: a commanded ramp
/// is not owed twice. One that does not takes the stop a stage further: quick stop, network stop, silence, one `stage`
/// after the other. `confirmation` after the ramp it stands or is told nothing any more, whatever the loop's rate: a
/// stage for which no cycle is left until then comes together with the next, or not at all. A stage is never gone back
/// on before reset().
///
/// A stop that was commanded (both speeds zero) ends when the wheel stands; one because of trouble is watched until
/// reset(): a wheel that turns again while the drives are in trouble takes it further. Thread: the drive base's; never
/// allocates.
class StopLadder {
 public:
  explicit StopLadder(const StopLimits& limits) noexcept : limits_(limits) {}

  /// Once a cycle, before what the drives are told. `stopping`: the command is zero for both wheels, or there is
  /// trouble. `trouble`: the drives were told to quick-stop.
  [[nodiscard]] StopStage update(Time now, bool stopping, bool trouble, const WheelFeedback& wheel) noexcept;
  [[nodiscard]] StopStage stage() const noexcept { return stage_; }
  /// A person's reset edge: the next stop begins anew.
  void reset() noexcept;

 private:
  /// What the wheel was told, falling with the ramp at most.
  void follow_orders(Time now, const WheelFeedback& wheel) noexcept;
  void begin(Time now, const WheelFeedback& wheel) noexcept;
  [[nodiscard]] bool is_over(Time now) const noexcept;
  /// Whether the feedback shows what the ramp allows now.
  [[nodiscard]] bool is_kept(Time now, const WheelFeedback& wheel) const noexcept;
  [[nodiscard]] bool is_at_rest(Time now, const WheelFeedback& wheel) const noexcept;
  [[nodiscard]] bool is_fresh(Time now, const WheelFeedback& wheel) const noexcept;
  void climb(Time now) noexcept;

  StopLimits limits_;
  StopStage stage_ = StopStage::kNone;
  bool under_way_ = false, ended_ = false;
  bool trouble_ = false;
  Time ordered_ = kNever, climbed_ = kNever;
  double longest_s_ = 0.0;  ///< of this stop: nothing is sent later to a wheel that does not stand
  bool confirmed_ = false;  ///< it stood then
  Time followed_ = kNever;
  double told_radps_ = 0.0, owed_radps_ = 0.0, speed_at_order_ = 0.0;
};

}  // namespace jaywalk
