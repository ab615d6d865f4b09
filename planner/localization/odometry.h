#pragma once
// Dead reckoning: from wheel angles, or without wheels from how the robot last moved.
#include <algorithm>
#include <array>
#include <cstddef>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"
#include "hal/types/wheels.h"

namespace jaywalk {
/// How far along its arc, and how far round, a differential drive went.
struct ArcStep {
  double distance_m = 0.0;
  double turn_rad = 0.0;
};

/// The pose after driving an arc of constant curvature, exactly.
[[nodiscard]] Pose2 after_arc(const Pose2& from, const ArcStep& step) noexcept;

/// Poses in a frame of its own, `odom`, that drifts against the map; the recent ones are remembered, so that a scan
/// can be placed at its own stamp. No allocation. Thread: the loop's.
class Odometry {
 public:
  explicit Odometry(const DriveModel& drive) : drive_(drive) {}

  /// Takes a reading with a new sequence number: what the wheels did since the last; after a silence in which scans
  /// were matched, what they do now. A step that is not finite, or faster than twice what the motors can do (encoders
  /// that restarted), counts as standing.
  ArcStep take(const WheelState& wheels) noexcept;
  /// Whether take() would count on from the reading before a silence, in place of what was guessed since: not after a
  /// match, nor where an encoder restarted.
  [[nodiscard]] bool bridges(const WheelState& wheels) const noexcept {
    return coasted_ && bridgeable_ && wheels.sequence > last_.sequence &&
           believable(counted(wheels), to_seconds(wheels.stamp - last_.stamp));
  }
  /// While it coasts: a match put it where it is, which no wheel knows better.
  void placed() noexcept { bridgeable_ = false; }
  /// From now on the robot turns by so much more with every metre than its wheels say (rad / m, to the left).
  void set_radius_bias(double turn_per_m) noexcept { radius_bias_ = turn_per_m; }
  /// While wheels are silent: moves by a pose in the robot's own frame.
  void coast(const Pose2& before_from_after, Time stamp) noexcept {
    if (!coasted_) bridgeable_ = has_wheels();
    coasted_ = true;
    twist_ = {};  // of wheels that say nothing
    remember({stamp, odom_from_robot() * before_from_after});
  }

  /// The newest pose is the wheels' own.
  [[nodiscard]] bool by_wheels() const { return has_wheels() && !coasted_; }
  [[nodiscard]] bool has_wheels() const { return last_.sequence != 0; }
  /// They have not said anything for so long before `stamp` that the robot may be elsewhere, or never.
  [[nodiscard]] bool wheels_silent(Time stamp) const noexcept;
  [[nodiscard]] const Twist2& twist() const { return twist_; }
  [[nodiscard]] Time stamp() const { return newest().stamp; }
  [[nodiscard]] const Pose2& odom_from_robot() const { return newest().odom_from_robot; }
  /// The pose at `stamp`: between remembered ones along a straight line, after the newest by its twist for up to
  /// 0.25 s, before the oldest the oldest.
  [[nodiscard]] Pose2 at(Time stamp) const noexcept;
  /// Whether at() knows it: not before the oldest, nor so long after the newest. Before the first pose anything goes.
  [[nodiscard]] bool remembers(Time stamp) const noexcept;

 private:
  struct Entry {
    Time stamp = kNever;
    Pose2 odom_from_robot;
  };
  static constexpr std::size_t kRemembered = 128;  ///< 2.5 s at 50 Hz

  [[nodiscard]] std::size_t oldest() const {
    return std::max(forgotten_, count_ > kRemembered ? count_ - kRemembered : 0);
  }
  [[nodiscard]] const Entry& newest() const { return entries_[count_ == 0 ? 0 : (count_ - 1) % kRemembered]; }
  void remember(const Entry& entry) noexcept {
    if (count_ > 0 && entry.stamp < newest().stamp) forgotten_ = count_;  // a clock set back: those were of other times
    entries_[count_ % kRemembered] = entry;
    ++count_;
  }
  [[nodiscard]] bool believable(const ArcStep& step, double seconds) const noexcept;

  DriveModel drive_;
  [[nodiscard]] ArcStep since_last(const WheelState& wheels) const noexcept;
  [[nodiscard]] ArcStep counted(const WheelState& wheels) const noexcept {
    const double left = (wheels.left_rad - last_.left_rad) * drive_.wheel_radius_m;
    const double right = (wheels.right_rad - last_.right_rad) * drive_.wheel_radius_m;
    return {0.5 * (left + right), (right - left) / drive_.track_width_m};
  }

  WheelState last_;
  double period_s_ = 0.0;  ///< between the last two readings
  Pose2 odom_from_robot_at_last_;
  bool coasted_ = false;     ///< since the last reading
  bool bridgeable_ = false;  ///< and no match since
  double radius_bias_ = 0.0;
  Twist2 twist_;
  std::array<Entry, kRemembered> entries_{};
  std::size_t count_ = 0;      ///< ever remembered
  std::size_t forgotten_ = 0;  ///< so many of them, whatever their room
};

/// Learns speed and turn from where matches put the robot, and says how far it has come since. Thread: the loop's.
class Coasting {
 public:
  /// A way, and how far off that may be, as standard deviations (m an axis, rad).
  struct Step {
    Pose2 before_from_after;
    double metres_std = 0.0, radians_std = 0.0;
  };

  /// At constant speed, off by what a wheelchair can accelerate by; for longer than three seconds it is taken to have
  /// stood, and may be anywhere. Nothing before the first scan (`from` kNever), and when time went backwards.
  [[nodiscard]] Step step(Time from, Time to) const noexcept;
  /// A match put it there; what no wheelchair can drive makes its speed unknown: zero.
  void placed(const Pose2& map_from_robot, Time stamp) noexcept;
  /// Nothing matched, and it is believed there: the speed is believed a little less.
  void not_placed(const Pose2& map_from_robot, Time stamp) noexcept;
  /// Ahead and turning: what of its speed the wheels would tell.
  [[nodiscard]] Twist2 twist() const { return {velocity_in_robot_.x, turn_radps_}; }

 private:
  Pose2 last_;
  Time last_stamp_ = kNever;
  Vec2 velocity_in_robot_;
  double turn_radps_ = 0.0;
};

}  // namespace jaywalk
