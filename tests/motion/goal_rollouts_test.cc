// Decisions: in worlds small enough to say what is right.
#include "planner/motion/goal_rollouts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/motion/guided.h"
#include "tests/motion/moment.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

namespace {

constexpr double kTick = 0.02;

MotionSetup setup_of(bool constant, const LaserModel& laser) {
  MotionSetup setup{.model = p3dx(), .constant_speed = constant, .goal_tolerance_m = 0.3, .tick_s = kTick};
  setup.model.laser = laser;
  return setup;
}

/// A P3-DX that does what it is told, and one mover that it sees as it is.
class Drive {
 public:
  explicit Drive(Vec2 goal, bool constant = false, const LaserModel& laser = p3dx().laser)
      : planner_(setup_of(constant, laser)) {
    go_to(goal);
  }

  void go_to(Vec2 goal) { moment_.go_to(goal); }
  void meet(Vec2 mover, Vec2 walks) { moment_.meet(mover, walks); }
  [[nodiscard]] const StallState& stall() const { return planner_.decision().stall; }

  test::Guided ground;
  Pose2& pose = moment_.pose;
  Twist2& twist = moment_.driven;
  bool blind_guide = false;
  double least_m = 10.0;    ///< between robot's and mover's middles
  bool in_its_way = false;  ///< the robot's middle was in the mover's zone (docs/reference/scenarios.md)
  double slowest = 10.0, fastest = -10.0;
  float blind_over = 0.0F;  ///< m/s, the most that a part of the body exceeded what is permitted where nothing looks

  /// Seconds until it is there; 0: not within `for_s`.
  double run(double for_s) {
    for (double t = 0.0; t < for_s; t += kTick) {
      moment_.now = time_from_seconds(clock_s_ + 1.0);
      clock_s_ += kTick;
      moment_.drive(planner_, kTick);
      slowest = t > 3.0 ? std::min(slowest, twist.v_mps) : slowest;
      fastest = std::max(fastest, twist.v_mps);
      blind_over =
          std::max(blind_over, blind_.too_fast(static_cast<float>(twist.v_mps), static_cast<float>(twist.w_radps)));
      if (moment_.has_mover) least_m = std::min(least_m, distance(pose.position(), moment_.mover));
      in_its_way = in_its_way || (moment_.has_mover && is_in_its_way());
      if (distance(pose.position(), moment_.input.goal_in_map) < 0.3) return t + kTick;
      if (static_cast<int>(t / kTick + 0.5) % 4 == 0) decide();
    }
    return 0.0;
  }

  /// The supervisor holds the robot.
  void hold(double for_s) {
    for (double t = 0.0; t < for_s; t += 4 * kTick) {
      clock_s_ += 4 * kTick;
      moment_.now = time_from_seconds(clock_s_ + 1.0);
      twist = {};
      decide();
    }
  }

  /// A person steers the robot straight forward or backward for `for_s` seconds; the planner only counts the way.
  void steer(double v_mps, double for_s) {
    tests::Moment steered(ground.map());
    steered.driven = {v_mps, 0.0};
    for (double t = 0.0; t < for_s; t += kTick) planner_.observe(steered.world(), {Intent::Kind::kStick});
    pose = {pose.x + v_mps * for_s * std::cos(pose.heading), pose.y + v_mps * for_s * std::sin(pose.heading),
            pose.heading};
  }

 private:
  [[nodiscard]] bool is_in_its_way() const {
    const Vec2 to_robot = pose.position() - moment_.mover;
    const double away = norm(to_robot);
    return away < 0.27 + 0.5 && dot(to_robot, moment_.walks) > std::cos(0.25 * kPi) * away * norm(moment_.walks);
  }

  void decide() {
    Guide guide = ground.towards(pose.position(), moment_.input.goal_in_map);
    const std::vector<float> nothing(static_cast<std::size_t>(guide.side) * static_cast<std::size_t>(guide.side),
                                     std::numeric_limits<float>::quiet_NaN());
    if (blind_guide) guide.to_go_s = nothing.data();
    moment_.plan.guide = guide;
    moment_.decide(planner_);
  }

  tests::Moment moment_{ground.map()};
  double clock_s_ = 0.0;  ///< runs on from one run() to the next
  GoalRollouts planner_;
  BlindRim blind_{p3dx().footprint, p3dx().laser};
};

}  // namespace

TEST_CASE("in the open it drives straight to the goal, at full speed") {
  Drive drive({4.0, 0.0});
  const double took = drive.run(20.0);
  CHECK(took > 0.0);
  CHECK(took < 3.7 / 0.6 + 2.5);  // speeding up costs 0.9 s, slowing down little
  CHECK(drive.fastest == Approx(0.6).margin(0.01));
}

TEST_CASE("the time to the goal is progress, and anew for each goal") {
  Drive drive({4.0, 0.0});
  (void)drive.run(2.0);
  const float to_first_s = drive.stall().least_to_go_s;
  CHECK(to_first_s > 3.0F);
  CHECK(to_first_s < 4.0F / 0.6F);
  drive.go_to({-4.0, 0.0});  // farther away than the first goal was at any time
  (void)drive.run(0.2);
  CHECK(drive.stall().least_to_go_s > 4.0F / 0.6F);

  Drive beside_a_walker({4.0, 0.0});
  beside_a_walker.meet({2.0, 3.0}, {0.0, 0.4});
  (void)beside_a_walker.run(2.0);
  CHECK(beside_a_walker.stall().least_to_go_s < 4.0F / 0.6F);
  CHECK_FALSE(beside_a_walker.stall().is_alone);
}

TEST_CASE("a wall that comes to be known makes the way longer, and no stall") {
  Drive drive({4.0, 0.0});
  (void)drive.run(2.0);
  const float least_s = drive.stall().least_to_go_s;
  drive.ground.wall({2.5, -3.0}, {2.5, 2.0});
  (void)drive.run(3.0);
  CHECK(drive.stall().least_to_go_s > least_s);
  CHECK(drive.stall().for_s < 1.5F);
}

TEST_CASE("seconds that bring it no nearer are lost, driving wins them back, another goal forgets them") {
  Drive drive({4.0, 0.0});
  (void)drive.run(3.0);
  CHECK(drive.stall().lost_s < 1.0F);
  drive.ground.wall({2.5, -4.0}, {2.5, 4.0}).wall({-2.0, -4.0}, {-2.0, 4.0}).wall({-2.0, -4.0}, {2.5, -4.0});
  drive.ground.wall({-2.0, 4.0}, {2.5, 4.0});
  (void)drive.run(6.0);
  const float lost_s = drive.stall().lost_s;
  CHECK(lost_s > 4.0F);
  drive.go_to({-1.0, 0.0});
  (void)drive.run(0.5);
  CHECK(drive.stall().lost_s < 1.0F);  // of another goal
}

TEST_CASE("a mover that crosses or comes head-on is passed without a touch, by a robot at constant speed too") {
  struct Meeting {
    Vec2 mover, walks;
    bool constant;
    double apart_m;
  };
  const Meeting meetings[] = {{{2.0, -1.9}, {0.0, 0.5}, false, 0.3},  // both would be at (2, 0) after 3.8 s
                              {{5.0, 0.0}, {-0.5, 0.0}, false, 0.2},
                              {{2.0, -1.9}, {0.0, 0.5}, true, 0.19}};
  for (const Meeting& meeting : meetings) {
    CAPTURE(meeting.mover.x, meeting.constant);
    Drive drive({4.0, 0.0}, meeting.constant);
    drive.meet(meeting.mover, meeting.walks);
    CHECK(drive.run(meeting.constant ? 40.0 : 25.0) > 0.0);
    CHECK(drive.least_m > 0.27 + meeting.apart_m);
    if (meeting.constant) CHECK(drive.slowest == Approx(0.6).margin(0.001));
  }
}

TEST_CASE("a wheelchair at 0.6 m/s is at rest before somebody who crosses 1.5 m ahead touches it") {
  const double walks_mps = GENERATE(0.8, 1.0, 1.2, 1.4);
  const double late_s = GENERATE(0.0, 0.3, 0.6);
  test::Guided ground;
  tests::Moment moment(ground.map());
  moment.go_to({5.0, 0.0});
  moment.driven = {0.6, 0.0};
  GoalRollouts planner({.model = wheelchair(), .tick_s = kTick});
  const Footprint body = wheelchair().footprint;
  const double touches_s = (1.5 - body.front_m) / 0.6 + late_s;  // its front is there then, if it drives on
  moment.meet({1.5, -walks_mps * touches_s}, {0.0, walks_mps});
  double touched_at_mps = 0.0;
  for (int tick = 0; tick < 150; ++tick) {
    moment.now += duration_from_seconds(kTick);
    moment.drive(planner, kTick);
    const Vec2 seen = Transform2(inverse(moment.pose)) * moment.mover;
    const Vec2 off{std::max({seen.x - body.front_m, -body.rear_m - seen.x, 0.0}),
                   std::max(std::fabs(seen.y) - body.half_width_m, 0.0)};
    if (norm(off) < 0.27) touched_at_mps = std::max(touched_at_mps, std::fabs(moment.driven.v_mps));
    if (tick % 4 != 0) continue;
    moment.plan.guide = ground.towards(moment.pose.position(), {5.0, 0.0});
    moment.decide(planner);
  }
  CAPTURE(walks_mps, late_s);
  CHECK(touched_at_mps < 0.05);
}

TEST_CASE("beside a wall, and facing it, the robot gets out of the way of a pedestrian who walks along it") {
  const double speed_mps = GENERATE(0.4, 0.5);
  const double from_m = GENERATE(2.0, 2.5);
  Drive drive({5.5, 0.0});
  drive.ground.wall({-4.0, 0.5}, {6.0, 0.5});
  drive.pose = {2.0, 0.0, 0.5 * kPi};
  drive.meet({2.0 + from_m, -0.5}, {-speed_mps, 0.0});
  (void)drive.run(8.0);
  CAPTURE(speed_mps, from_m);
  CHECK_FALSE(drive.in_its_way);
  CHECK(drive.least_m > 0.27 + 0.3);
}

TEST_CASE("out of a niche it backs, and turns no faster than what its laser never sees permits") {
  Drive drive({-2.0, 2.5});
  drive.ground.wall({-0.8, 0.4}, {0.5, 0.4}).wall({-0.8, -0.4}, {0.5, -0.4}).wall({0.5, -0.4}, {0.5, 0.4});
  CHECK(drive.run(30.0) > 0.0);
  CHECK(drive.slowest < -0.1);
  CHECK(drive.blind_over <= 0.0F);
}

TEST_CASE("where nothing looks behind it backs fast only as far as it has just driven forward") {
  LaserModel all_round = p3dx().laser;
  all_round.fov_rad = 2.0 * kPi;
  for (const auto& [laser, mps] : {std::pair{p3dx().laser, 0.12}, std::pair{all_round, 0.3}}) {
    Drive drive({-5.0, 0.0}, false, laser);
    drive.ground.wall({-4.0, 0.4}, {1.4, 0.4}).wall({-4.0, -0.4}, {1.4, -0.4}).wall({1.4, -0.4}, {1.4, 0.4});
    (void)drive.run(3.0);
    CHECK(drive.twist.v_mps == Approx(-mps).margin(0.01));  // it has not driven forward yet

    drive.go_to({0.8, 0.0});
    CHECK(drive.run(20.0) > 0.0);
    drive.go_to({-5.0, 0.0});
    while (drive.twist.v_mps >= 0.0) (void)drive.run(kTick);
    const Vec2 from = drive.pose.position();
    while (distance(from, drive.pose.position()) < 0.2) (void)drive.run(kTick);
    CHECK(drive.twist.v_mps < -0.2);
    while (distance(from, drive.pose.position()) < 0.8) (void)drive.run(kTick);
    CHECK(drive.twist.v_mps == Approx(-mps).margin(0.01));

    drive.twist = {};
    drive.steer(0.3, 2.0);
    drive.steer(0.0, 1.2);  // at rest for longer than a second
    (void)drive.run(2.0);
    CHECK(drive.twist.v_mps == Approx(-mps).margin(0.01));

    drive.twist = {};
    drive.steer(0.3, 2.0);
    drive.steer(-0.3, 2.0);  // the person has backed over the half metre
    (void)drive.run(2.0);
    CHECK(drive.twist.v_mps == Approx(-mps).margin(0.01));
  }
}

TEST_CASE("a guide that is no number moves nobody") {
  Drive drive({4.0, 0.0});
  drive.blind_guide = true;
  CHECK(drive.run(3.0) == 0.0);
  CHECK(norm(drive.pose.position()) < 0.2);
}

TEST_CASE("without a decision for half a second it stops") {
  tests::Moment moment;
  moment.go_to({4.0, 0.0});
  moment.driven = {0.5, 0.3};
  GoalRollouts planner({.model = p3dx()});
  for (int k = 0; k < 100; ++k) moment.now += duration_from_seconds(kTick), moment.drive(planner, 0.0);
  CHECK(moment.driven == Twist2{});
}

TEST_CASE("a robot that has rested forgets how far it had turned: it turns the short way, though that ends a circle") {
  const double rested_s = GENERATE(0.5, 10.0);
  Drive drive({5.0, 0.0});
  drive.run(1.0);
  for (const double heading : {1.3, 2.6, 3.9, 5.0}) {  // to the left, and no nearer
    drive.pose.heading = wrap_angle(heading);
    drive.run(kTick);
  }
  drive.hold(rested_s);
  drive.run(1.0);
  CAPTURE(rested_s, drive.twist.w_radps);
  CHECK((drive.twist.w_radps > 0.1) == (rested_s > 5.0));
}
