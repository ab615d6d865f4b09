#pragma once
// Drive bases on wires, and the checks that all of them share.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "hal/hal.h"
#include "hal/types/errors.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"

namespace jaywalk {

/// A drive base at the end of a wire: what the loop sees of it is a DriveBase; what surrounds the loop sees this.
///
/// At any trouble the wheels are stopped; they move again only after reset() and a command of zero. That holds at
/// start too. Thread: the loop's, or the one that arms and disarms while no loop runs.
class WiredDrive : public DriveBase {
 public:
  /// Start-up only, may wait up to some seconds: sets the drives up and has each prove that it stops by itself.
  /// Returns what each said, a line a setting, for the record. Throws StartupError that names what was not proved.
  virtual std::vector<std::string> arm() = 0;
  /// Start-up only, in place of arm(): asks the drive on side 0 (left) or 1 what it is and how it is set. Changes
  /// nothing, no wheel gets torque. Returns what it said; throws StartupError where it could not be armed so.
  [[nodiscard]] virtual std::string inspect(std::size_t side) = 0;
  /// Also in latest().trouble.
  [[nodiscard]] virtual DriveTrouble trouble() const noexcept = 0;
  /// Whether a drive that was heard says nothing now, whatever the trouble: a loose plug, no power.
  [[nodiscard]] virtual bool is_silent() const noexcept { return false; }
  /// A person's reset edge, while the wheels stand: forgets the trouble. Where there was one, both drives are proved
  /// anew, whole, before they get torque; that goes on with latest() and command() until is_proved() or the next
  /// trouble.
  virtual void reset() noexcept = 0;
  /// Both drives passed the whole proof since they last restarted, dropped out or changed state by themselves.
  [[nodiscard]] virtual bool is_proved() const noexcept = 0;
  /// The frame of another master that is the trouble; nothing where there was none.
  [[nodiscard]] virtual std::optional<CanFrame> foreign_frame() const noexcept { return std::nullopt; }
  /// Both wheels follow commands.
  [[nodiscard]] virtual bool is_enabled() const noexcept = 0;
  /// Takes the torque away, at rest: after the last command. To be called again and again until !is_enabled().
  virtual void disarm() noexcept = 0;
};

/// A second way to the same wheels, for a thread that has nothing to do with the loop's: tells the drives to stop as
/// fast as they were set to, and does not wait.
using EmergencyBrake = std::function<void()>;

/// One wheel's drive on a CAN bus.
struct CanAxis {
  std::uint8_t node = 0;  ///< its number; of a VESC the controller's
  /// Counts, motor turns or electrical turns (pole pairs times motor turns) a radian of the wheel; negative where the
  /// motor is mounted the other way round.
  double per_rad = 0.0;
};

/// Throws StartupError for an axis without a scale, with a number that its kind ("ODrive node") cannot have, or with
/// that of the other or of the controller, `own`.
void require_axes(const std::array<CanAxis, 2>& axes, const std::string& kind, int lowest, int highest, int own = -1);

/// `value`, cut at `most` either way, to the nearest whole number.
[[nodiscard]] inline std::int32_t rounded_within(double value, double most) noexcept {
  const double within = std::clamp(value, -most, most);
  return static_cast<std::int32_t>(within < 0.0 ? within - 0.5 : within + 0.5);
}

/// True where a wheel's counter jumped, by a restart or a slip: the difference is no way.
///
/// `turned_rad` since the position before, `since_s` ago, of a wheel that turns with `speed_radps`. Allowed beyond what
/// the speed explains: some steps of the coarsest counter (six Hall states an electrical turn), the way that a wheel
/// gains with 20 rad/s2, as hard a stop as drives are set to, and 20 ms by which speed and position are measured apart.
[[nodiscard]] inline bool jumps(double turned_rad, double speed_radps, double since_s) noexcept {
  constexpr double kSteps_rad = 0.05, kHardest_radps2 = 20.0, kApart_s = 0.02;
  const double explained_rad = speed_radps * (since_s + kApart_s);
  const double nearest_rad = std::clamp(turned_rad, std::min(explained_rad, 0.0), std::max(explained_rad, 0.0));
  return !(std::fabs(turned_rad - nearest_rad) <= kSteps_rad + 0.5 * kHardest_radps2 * since_s * since_s);
}

/// Token bucket that detects two devices with the same number by the rate of a frame that only one device may send.
///
/// The bucket fills at 1.5 times the due rate. A device's clock may be fast, and CAN repeats a frame after a disturbed
/// last bit (ISO 11898-1). Two devices send at twice the due rate: their fourth pair finds the bucket empty.
class FrameRate {
 public:
  /// Adds tokens for frames that became due, such as one with each SYNC.
  void expect(double frames) noexcept { store_ = std::min(store_ + kShare * frames, kStore); }
  /// Takes a token for a frame that came; false where none is left.
  [[nodiscard]] bool take() noexcept {
    if (store_ < 1.0) return false;
    store_ -= 1.0;
    return true;
  }
  /// Takes a token for a frame that is due once a period.
  [[nodiscard]] bool take_at(Time stamp, Duration period) noexcept {
    if (last_ != kNever) expect(to_seconds(stamp - last_) / to_seconds(period));
    last_ = stamp;
    return take();
  }

 private:
  static constexpr double kShare = 1.5, kStore = 3.0;  ///< frames

  double store_ = kStore;
  Time last_ = kNever;
};

/// Node, code and its meaning: "node 5: emergency 2310h (continuous over-current)"; empty where no fault was told. Not
/// for the loop.
[[nodiscard]] std::string describe(const DriveFault& fault);

/// Meanings of an ODrive's error bits, firmware 0.6, joined by "; "; empty for bits that are not known.
[[nodiscard]] std::string odrive_error_words(std::uint32_t errors);
/// Meanings of the bits of arcos::Fault, likewise.
[[nodiscard]] std::string arcos_fault_words(std::uint32_t faults);
/// Meaning of the procedure result in an ODrive's heartbeat: "timeout".
[[nodiscard]] std::string odrive_procedure_words(std::uint8_t result);

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
  void reset() noexcept { *this = StopLadder(limits_); }

 private:
  /// What each wheel was told, falling with the ramp at most.
  void follow_orders(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept;
  void begin(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept;
  [[nodiscard]] bool is_over(Time now) const noexcept;
  /// Whether the feedback shows what the ramp allows now.
  [[nodiscard]] bool is_kept(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept;
  [[nodiscard]] bool is_at_rest(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept;
  [[nodiscard]] bool is_fresh(Time now, const WheelFeedback& wheel) const noexcept {
    return age(wheel.stamp, now) <= limits_.fresh;
  }
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
