#pragma once
#include <array>

#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"
#include "planner/motion/body_map.h"
#include "planner/motion/footprint_guide.h"
#include "planner/motion/manoeuvre_drive.h"
#include "planner/motion/manoeuvre_search.h"

namespace jaywalk {

/// At a goal with a heading: the robot comes to rest and turns on the spot, the short way where its outline keeps clear
/// of what stands, else the long way. Where it can turn neither way it searches a manoeuvre that ends there with that
/// heading, and where there is none it waits and says so. A way that the supervisor has refused for a second, a
/// pedestrian standing in it say, is left alone for ten.
///
/// It takes over within kStopWithin of the goal's tolerance, or anywhere within it where the robot stands, and lets go
/// when the robot finds itself outside of it, or the goal changes. Memory in the constructor (20 MB, most of it touched
/// by searches only). Thread: the loop's.
class GoalTurn {
 public:
  /// A body that is nearly round may turn over ground that was never seen.
  GoalTurn(const Footprint& footprint, const MotionLimits& limits, bool is_nearly_round);

  /// Each tick, before command(): what is asked for and how the robot moves. `driven`: as last permitted.
  void aim(const OperatorInput& input, const Pose2& map_from_robot, const Twist2& driven) noexcept;
  /// Drive manoeuvre() while that is active, else command(), in place of the path.
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// The twist that turns on the spot from here, not ramped; zero while it still rolls or is to stand.
  [[nodiscard]] Twist2 command(const Pose2& map_from_robot) noexcept;
  /// While active: looks where it may turn, with each new plan. Costs as BodyMap::draw() and, where it can turn neither
  /// way, ManoeuvreSearch::find().
  void update(const GuideInput& input) noexcept;
  /// Neither way, nor any other: it waits.
  [[nodiscard]] bool blocked() const noexcept { return active_ && blocked_; }
  /// The way to the heading where it takes more than a turn on the spot.
  [[nodiscard]] ManoeuvreDrive& manoeuvre() noexcept { return drive_; }

  static constexpr double kStopWithin = 2.0 / 3.0;

 private:
  [[nodiscard]] bool arrives(const Pose2& map_from_robot) const noexcept;
  void begin() noexcept;
  [[nodiscard]] bool goes_on(const GuideInput& input, bool refused) const noexcept;
  [[nodiscard]] bool choose_way(const Pose2& here) noexcept;
  [[nodiscard]] bool has_room(const Pose2& here) const noexcept;
  [[nodiscard]] bool fits(const Pose2& here, double turn_rad, double margin_m) const noexcept;
  [[nodiscard]] Time& refused_until(double turn_rad) noexcept { return refused_until_[turn_rad < 0.0 ? 1 : 0]; }
  [[nodiscard]] bool is_refused(const GuideInput& input) noexcept;
  void seek(const Pose2& here) noexcept;
  void note_found() noexcept;
  bool look_round(const Pose2& here) noexcept;
  void draw_off(const Pose2& here, double off_m) noexcept;
  void seek_back(const Pose2& here, bool refused) noexcept;
  [[nodiscard]] bool search(const Pose2& here) noexcept;

  MotionLimits limits_;
  bool is_nearly_round_;
  BodyMap map_;
  ManoeuvreSearch search_;
  ManoeuvreDrive drive_;
  OperatorInput input_;
  Twist2 driven_;
  bool pedestrian_hidden_ = false;  ///< GuideInput's
  bool active_ = false, settled_ = false, blocked_ = false;
  bool away_ = false;    ///< on a manoeuvre, which may lead out of the goal's tolerance
  bool chosen_ = false;  ///< to_go_rad_ leads along a way that was found free
  double to_go_rad_ = 0.0;
  double heading_before_ = 0.0;
  Time now_{};                                         ///< GuideInput's
  std::array<Time, 2> refused_until_{kNever, kNever};  ///< turning left, right is not tried again before
  HeldTime refused_;                                   ///< the supervisor has refused to move
  HeldTime waited_;                                    ///< nothing was found
  int rounds_ = 0;                                     ///< how often it has looked round meanwhile
  Time searched_at_ = kNever;                          ///< the same
  std::size_t searches_ = 0;
  Manoeuvre straight_;
  double off_m_ = 0.0;  ///< signed: the last way straight off
};

}  // namespace jaywalk
