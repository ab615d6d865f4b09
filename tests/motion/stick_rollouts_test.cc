// A stick and what is made of it: in worlds small enough to say what is right.
#include "planner/motion/stick_rollouts.h"

#include <cmath>
#include <limits>

#include "tests/motion/ground.h"
#include "tests/motion/moment.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

namespace {

constexpr double kTick = 0.02;

MotionSetup setup_of(const RobotModel& model, bool assisted = true) {
  return {.model = model, .steering = assisted ? StickUse::kShared : StickUse::kByHand, .tick_s = kTick};
}

/// A robot that does what it is told.
class Ride {
 public:
  explicit Ride(const RobotModel& model, const Stick& pushed = {}, const EvidenceMap& ground = tests::open_ground(),
                bool assisted = true)
      : footprint_(model.footprint), moment_(ground), shared_(setup_of(model, assisted)) {
    moment_.input.steers = true;
    stick = pushed;
    moment_.tracks.reserve(1);
  }
  void meet(Vec2 at, Vec2 velocity) { moment_.meet(at, velocity); }

  Pose2& pose = moment_.pose;
  Twist2& twist = moment_.driven;
  Stick& stick = moment_.input.stick;
  Vec2& mover = moment_.mover;
  std::uint64_t heap_calls = 0;

  void run(double for_s) {
    const double until = t_ + for_s;
    for (; t_ < until; t_ += kTick) {
      const AllocationGuard guard;
      moment_.now = time_from_seconds(t_ + 1.0);
      moment_.drive(shared_, kTick);
      if (static_cast<int>(t_ / kTick + 0.5) % 4 == 0) moment_.decide(shared_);
      heap_calls += guard.calls();
    }
  }
  /// From the outline to a point of the map, m.
  [[nodiscard]] double gap_to(Vec2 point) const { return footprint_.distance_to(Transform2(inverse(pose)) * point); }

 private:
  Footprint footprint_;
  tests::Moment moment_;
  StickRollouts shared_;
  double t_ = 0.0;
};

}  // namespace

TEST_CASE("away from everything a stick's wish is granted whole, turns and all") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  Ride ride(model), by_hand(model, {}, tests::open_ground(), false);
  for (const Stick stick : {Stick{1.0, 0.0}, Stick{0.5, 0.3}, Stick{0.0, -0.6}, Stick{-0.5, 0.0}}) {
    ride.stick = by_hand.stick = stick;
    ride.run(2.5), by_hand.run(2.5);
    CHECK(ride.twist.v_mps == Approx(by_hand.twist.v_mps).margin(1e-6));
    CHECK(ride.twist.w_radps == Approx(by_hand.twist.w_radps).margin(1e-6));
  }
  CHECK(ride.heap_calls == 0);
}

TEST_CASE("full ahead is the robot's fastest, by either mode, half the stick is half of it") {
  Ride ride(p3dx(), {1.0, 0.0});
  ride.run(3.0);
  CHECK(ride.twist.v_mps == Approx(0.6).margin(1e-3));
  ride.stick = {0.5, 0.0};
  ride.run(3.0);
  CHECK(ride.twist.v_mps == Approx(0.3).margin(1e-3));
  ride.stick = {-1.0, 0.0};
  ride.run(4.0);
  CHECK(ride.twist.v_mps == Approx(-0.29).margin(1e-3));  // the stick may ask for all that the supervisor permits
}

TEST_CASE("a stick in the middle brings the robot to rest at once, on its arc") {
  Ride ride(p3dx(), {1.0, 0.25});  // 0.3 rad/s: a circle of 2 m
  ride.run(2.5);
  const Pose2 before = ride.pose;
  const double curvature = ride.twist.w_radps / ride.twist.v_mps;
  ride.stick = {};
  ride.run(1.0);
  CHECK(ride.twist.w_radps / ride.twist.v_mps == Approx(curvature).margin(0.02));
  ride.run(1.5);  // from 0.6 m/s at 0.75 m/s3 and 0.67 m/s2 at most: 1.8 s
  CHECK(ride.twist == Twist2{});
  CHECK(distance(ride.pose.position(), before.position()) < 0.6);  // 0.6 m/s * 1.8 s / 2, and a tick
  ride.run(2.0);
  CHECK(ride.twist == Twist2{});
}

TEST_CASE("a wall ahead is never touched, however long the stick is pushed") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  const double slant = GENERATE(0.0, 0.5, 1.0);
  tests::WalledGround ground;
  ground.wall({3.0 - 2.5 * slant, -2.5}, {3.0 + 2.5 * slant, 2.5});
  Ride ride(model, {1.0, 0.0}, ground.map());
  double least = 10.0, nearest = 10.0;
  for (int k = 0; k < 400; ++k) {
    ride.run(kTick * 1.5);
    for (double y = -2.5; y <= 2.5; y += 0.02) nearest = std::min(nearest, ride.gap_to({3.0 + slant * y, y}));
    least = std::min(least, nearest);
  }
  CAPTURE(model.name, slant, ride.pose.x, ride.pose.y, ride.pose.heading);
  CHECK(least > 0.02);
  CHECK(least < 0.25);  // it goes as far as it may
  if (slant == 0.0) CHECK(ride.twist.v_mps < 0.02);
}

TEST_CASE("it steers round a post that it would clip, and on, one straight ahead it stands before") {
  tests::WalledGround ground;
  ground.wall({2.5, 0.1}, {2.5, 0.35});
  Ride ride(p3dx(), {1.0, 0.0}, ground.map());
  ride.run(9.0);
  CHECK(ride.pose.x > 3.5);
  CHECK(std::fabs(ride.pose.y) < 1.5);
  tests::WalledGround other;
  other.wall({2.5, -0.15}, {2.5, 0.15});
  Ride straight(p3dx(), {1.0, 0.0}, other.map());
  straight.run(9.0);
  CHECK(straight.gap_to({2.5, 0.0}) > 0.02);
  CHECK(straight.twist.v_mps < 0.02);
}

TEST_CASE("it does not drive into somebody who comes") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  Ride ride(model, {1.0, 0.0});
  ride.meet({3.0, -3.0}, {0.0, 0.8});  // crosses at 3 m after 3.75 s
  double least = 10.0;
  for (int k = 0; k < 400; ++k) {
    ride.run(kTick);
    least = std::min(least, ride.gap_to(ride.mover) - 0.27);
  }
  CAPTURE(model.name);
  CHECK(least > 0.1);
  CHECK(ride.pose.x > 2.0);  // and goes on
}

TEST_CASE("in a walker's way already, with nothing left to lose by that, it still stops before it touches the walker") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  const double aside = GENERATE(0.0, 0.2);
  Ride ride(model, {1.0, 0.0});
  ride.meet({model.footprint.front_m + 1.6, aside}, {-0.4, 0.0});  // head-on; heeds nobody
  for (int k = 0; k < 300 && ride.gap_to(ride.mover) > 0.27 + 0.02; ++k) ride.run(kTick * 0.5);
  CAPTURE(model.name, aside, ride.pose.x, ride.twist.v_mps);
  const bool met = ride.gap_to(ride.mover) < 0.3;  // or it has let it pass
  CHECK((!met || std::fabs(ride.twist.v_mps) < 0.02));
}

TEST_CASE("through a door by a hand that trembles: the turn that is asked for now is not asked for to the end") {
  tests::WalledGround ground;
  ground.wall({2.5, -3.0}, {2.5, -0.35}).wall({2.5, 0.55}, {2.5, 3.0});  // 0.90 m, its middle 0.10 m to the left
  const double turn = GENERATE(-0.3, -0.2, 0.2, 0.3);
  const double hold_s = GENERATE(0.3, 0.5, 0.8, 1.2);
  Ride ride(wheelchair(), {}, ground.map());
  for (int k = 0; k * hold_s < 20.0 && ride.pose.x < 3.2; ++k) {
    const double off = std::atan2(-ride.pose.y, 5.0 - ride.pose.x) - ride.pose.heading;
    ride.stick = {1.0, 1.2 * off + (k % 2 == 0 ? turn : -turn)};
    ride.run(hold_s);
  }
  CAPTURE(turn, hold_s, ride.pose.x, ride.pose.y);
  CHECK(ride.pose.x > 3.2);
}

TEST_CASE("half a second without a decision stops it") {
  tests::Moment moment;
  moment.input.steers = true;
  moment.input.stick = {1.0, 0.0};
  StickRollouts shared(setup_of(p3dx()));
  moment.drive(shared, 0.0);
  CHECK(moment.driven == Twist2{});  // before the first
  moment.driven = {0.3, 0.0};
  moment.drive(shared, 0.0);
  CHECK(moment.driven.v_mps < 0.3);
}

TEST_CASE("a stick that is no number asks for nothing") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MotionBounds bounds{.speed = 0.6F, .back = 0.3F, .turn = 1.2F};
  CHECK(stick_command({nan, 1.0}, bounds).w == 0.0F);
  CHECK(stick_command({1.0, nan}, bounds).v == 0.0F);
  CHECK(stick_command({7.0, 0.0}, bounds).v == 0.6F);
  CHECK(stick_command({-1.0, 0.5}, bounds).v == -0.3F);
  CHECK(stick_command({-1.0, 0.5}, bounds).w == Approx(0.6F));
}

TEST_CASE("to stand in place of full speed costs some three seconds, the wish itself costs none") {
  // At 0.6 m/s: 0.06 m, 0.12 m ... 1.8 m off, 0.93 m on average, times 2 over 0.6 m/s: 3.1 s.
  const MotionBounds bounds{
      .speed = 0.6F, .back = 0.3F, .turn = 1.2F, .turn_accel = 2.0F, .accel = 0.5F, .slowing = 0.8F, .jerk = 0.75F};
  const RobotState driving{0.0F, 0.0F, 0.0F, 0.6F, 0.0F, 0.0F};
  const StickRollout way = roll_out_stick(driving, {0.6F, 0.0F}, bounds);
  std::array<RobotState, kFollowedSteps> stands{};
  CHECK(seconds_off(way, stands.data(), bounds) == Approx(3.1F).margin(0.01));
  CHECK(seconds_off(way, way.data(), bounds) == 0.0F);
}

TEST_CASE("an outline is as far from a wall as the body, ahead, beside and at its corners") {
  tests::WalledGround ground;
  ground.wall({2.0, -2.0}, {2.0, 2.0});
  LocalGround local;
  const Guide& guide = local.update(ground.map(), {0.0, 0.0}, {});
  const BodyOutline body = BodyOutline::of(wheelchair().footprint);
  CHECK(body.clearance(guide, 1.0F, 0.0F, {1.0F, 0.0F}) == Approx(0.25F).margin(0.01));   // 2 - 1 - 0.75
  CHECK(body.clearance(guide, 1.0F, 0.0F, {0.0F, 1.0F}) == Approx(0.675F).margin(0.01));  // 2 - 1 - 0.325
  CHECK(body.clearance(guide, 1.0F, 0.0F, {-1.0F, 0.0F}) == Approx(0.65F).margin(0.01));  // 2 - 1 - 0.35
  // Turned by 45 degrees a front corner is (0.75 + 0.325) / sqrt 2 = 0.76 ahead.
  CHECK(body.clearance(guide, 1.0F, 0.0F, {0.70710678F, 0.70710678F}) == Approx(0.24F).margin(0.01));
  CHECK(body.clearance(guide, 1.8F, 0.0F, {1.0F, 0.0F}) < -0.1F);
}

TEST_CASE("a body's gap to a place is that of its rectangle") {
  const Footprint f = p3dx().footprint;
  const RobotBody body = robot_body(f, p3dx().limits, p3dx().laser, 1.0);
  CHECK(body.gap(0.0F, 0.0F) == 0.0F);
  CHECK(body.gap(static_cast<float>(f.front_m) + 0.3F, static_cast<float>(f.half_width_m) + 0.4F) == Approx(0.5F));
  CHECK(body.gap(-static_cast<float>(f.rear_m) - 0.2F, 0.0F) == Approx(0.2F));
  CHECK(body.gap(0.0F, -static_cast<float>(f.half_width_m) - 0.1F) == Approx(0.1F));
}

TEST_CASE("every shape is at rest within five seconds, and none drives faster than wished or the other way") {
  const RobotBody body = robot_body(p3dx().footprint, p3dx().limits, p3dx().laser, 1.0);
  const Command wish{0.4F, 0.3F};
  each_shape(body.bounds, [&](const StickShape& shape) {
    Trajectory trajectory;
    RobotState robot{0.0F, 0.0F, 0.0F, 0.6F, 0.0F, 0.0F};
    make(shape, wish, robot, body.bounds, trajectory);
    for (int step = 0; step < kStickSteps; ++step) {
      const Command command = trajectory.commands[static_cast<std::size_t>(step)];
      REQUIRE(command.v >= 0.0F);
      REQUIRE(command.v <= 0.4F);
      robot = moved(robot, command, body.bounds, kStepS);
    }
    REQUIRE(std::fabs(robot.v) < 0.02F);
    REQUIRE(std::fabs(robot.w) < 0.02F);
  });
}
