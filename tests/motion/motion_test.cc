// Motion's door: what each kind rests on, asks of the planner and tells of itself.
#include "planner/motion/motion.h"

#include <utility>

#include "apps/rivals/baseline.h"
#include "planner/paper/paper.h"
#include "tests/motion/guided.h"
#include "tests/motion/moment.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

namespace {

MotionSetup setup_of(bool constant_speed = false, StickUse steering = StickUse::kNone) {
  return {.model = p3dx(), .constant_speed = constant_speed, .steering = steering};
}

/// What a command rests on in that moment.
Time rests_on(Motion& motion, const tests::Moment& moment) {
  motion.observe(moment.world(), moment.intent());
  return motion.status().rests_on;
}

}  // namespace

TEST_CASE("commands at constant speed rest on the path, and on nothing when a plan has none") {
  tests::Moment moment;
  moment.go_to({4.0, 0.0});
  const auto on_path = paper::make_motion(setup_of(true));
  moment.plan.status = PlanStatus::kOk;
  CHECK(rests_on(*on_path, moment) == moment.plan.stamp);
  moment.plan.status = PlanStatus::kNoPath;
  CHECK(rests_on(*on_path, moment) == kNever);
}

TEST_CASE("roll-outs rest on the older of the scan decided on and the plan, by a stick on the scan alone") {
  tests::Moment moment;
  moment.go_to({4.0, 0.0});
  moment.plan.status = PlanStatus::kOk;
  const auto motion = make_motion(setup_of(false, StickUse::kShared));
  CHECK(rests_on(*motion, moment) == kNever);  // nothing is decided yet
  moment.input.has_goal = false;
  moment.input.steers = true;
  moment.input.stick = {0.5, 0.0};
  moment.decide(*motion);
  CHECK(rests_on(*motion, moment) == moment.scan.stamp);
  CHECK(motion->status().stick_asks.v_mps == Approx(0.3).margin(1e-5));
  CHECK(motion->command(moment.world(), moment.intent()).v_mps > 0.0);
  moment.input.steers = false;
  moment.drive(*motion, 0.02);
  CHECK(motion->status().stick_asks == Twist2{});
}

TEST_CASE(
    "roll-outs ask for plans rarely and past pedestrians, a path's follower with each scan and with them marked") {
  tests::Moment moment;
  Track walker;
  walker.id = 1;
  walker.position_in_map = {1.0, 0.0};
  walker.moving = walker.is_pedestrian = true;
  moment.tracks = {walker};
  moment.go_to({4.0, 0.0});
  moment.plan.status = PlanStatus::kOk;
  for (const bool follows : {false, true}) {
    const auto motion = (follows ? paper::make_motion : make_motion)(setup_of(follows));
    moment.decide(*motion);
    const PlanRequest request = motion->request(moment.world());
    CHECK(request.stamp == moment.scan.stamp);
    CHECK(request.goal_in_map == Vec2{4.0, 0.0});
    CHECK(request.moving.size() == (follows ? 1 : 0));
    CHECK(request.masked.size() == (follows ? 0 : 1));
    CHECK((motion->plan_every() > Duration{0}) != follows);
    CHECK((motion->rollouts() != nullptr) != follows);
  }
}

TEST_CASE("the time from poses is asked for where corners may swing into something, never at constant speed") {
  test::Guided ground;
  ground.wall({-4.0, 1.0}, {4.0, 1.0});
  const auto asks = [&](const RobotModel& model, Vec2 at, Vec2 goal, bool constant = false) {
    tests::Moment moment(ground.map());
    moment.pose = {at.x, at.y, 0.0};
    moment.go_to(goal);
    moment.plan.guide = ground.towards(at, goal);
    MotionSetup setup = setup_of(constant);
    setup.model = model;
    return make_motion(setup)->request(moment.world()).poses.is_asked;
  };
  const Vec2 open{0.0, -1.0}, beside{0.0, 0.6}, goal{0.0, -3.5};
  CHECK_FALSE(asks(p3dx(), open, goal));
  CHECK(asks(p3dx(), beside, goal));
  CHECK(asks(wheelchair(), open, goal));
  CHECK_FALSE(asks(p3dx(), beside, goal, true));
}

TEST_CASE("at its goal a robot turns to the heading wanted there, whatever brought it, at constant speed it cannot") {
  for (const auto& [make, constant] :
       {std::pair<MakeMotion, bool>{make_motion, false}, {make_motion, true}, {paper::make_motion, true}}) {
    tests::Moment moment;
    moment.go_to({});
    moment.input.goal_heading_rad = 1.0;
    const auto motion = make(setup_of(constant));
    moment.drive(*motion, 0.02);
    CHECK(motion->status().turns_at_goal != constant);
    CHECK_FALSE(motion->status().turn_blocked);
  }
}

TEST_CASE("a planner of others is a motion of its own, without a name it is ours") {
  const MotionSetup setup = setup_of();
  for (const char* name : {"none", "replan", "dwa", "orca"})
    CHECK(baseline::maker_of(name)(setup)->rollouts() == nullptr);
  CHECK(baseline::maker_of("")(setup)->rollouts() != nullptr);
}
