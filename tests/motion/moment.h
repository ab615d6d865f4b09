#pragma once
#include <vector>

#include "planner/motion/motion.h"
#include "tests/motion/ground.h"
#include "tests/motion/track_past.h"

namespace jaywalk::tests {

/// Ground without walls.
inline const EvidenceMap& open_ground() {
  static const WalledGround open;
  return open.map();
}

/// All that a World looks at: in the open, with no mover about, no scan and no plan until a test says otherwise.
struct Moment {
  explicit Moment(const EvidenceMap& ground = open_ground()) : still(ground) {
    scan.beam_count = 3;
    scan.range_max_m = 25.0F;
    scan.stamp = plan.stamp = now;
  }

  const EvidenceMap& still;
  Time now = time_from_seconds(1.0);
  Pose2 pose;
  Twist2 driven;
  OperatorInput input;
  LaserScan scan;
  Plan plan;
  std::vector<Track> tracks;  ///< of the same time; all of them count as moving
  bool has_mover = false;     ///< which is then the only track
  Vec2 mover, walks;
  TrackPast past;

  void go_to(Vec2 goal) { input.has_goal = true, input.goal_in_map = goal; }
  /// From now on a mover walks straight on from there, tracked as it is.
  void meet(Vec2 at, Vec2 velocity) { has_mover = true, mover = at, walks = velocity; }
  [[nodiscard]] motion::Intent intent() const {
    using Kind = motion::Intent::Kind;
    return {input.steers ? Kind::kStick : input.has_goal ? Kind::kGoal : Kind::kRest, input.stick};
  }
  [[nodiscard]] motion::World world() const {
    return {.now = now,
            .map_from_robot = pose,
            .driven = driven,
            .input = input,
            .scan = scan,
            .map_from_laser = pose,
            .perceived = {.tracks = tracks, .moving = tracks, .still = still},
            .plan = plan};
  }

  /// A tick of a robot that does what it is told, and where it is then.
  void drive(motion::Motion& motion, double tick_s) {
    motion.observe(world(), intent());
    driven = motion.command(world(), intent());
    const Vec2 along = direction(pose.heading + 0.5 * driven.w_radps * tick_s);
    pose = {pose.x + driven.v_mps * tick_s * along.x, pose.y + driven.v_mps * tick_s * along.y,
            wrap_angle(pose.heading + driven.w_radps * tick_s)};
    mover = mover + walks * tick_s;
  }
  /// With a new scan and a new plan.
  void decide(motion::Motion& motion) {
    scan.stamp = plan.stamp = now;
    if (has_mover) tracks.assign(1, past.of(mover, walks, now));
    for (Track& track : tracks) track.stamp = now;
    motion::World news = world();
    news.new_scan = news.new_plan = true;
    motion.decide(news, intent());
  }
};

}  // namespace jaywalk::tests
