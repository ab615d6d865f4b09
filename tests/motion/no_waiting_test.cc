#include <algorithm>
#include <memory>
#include <random>

#include "hal/types/robot_model.h"
#include "planner/motion/proposals.h"
#include "planner/motion/situation.h"
#include "tests/motion/guided.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

namespace {

const RobotModel kRobot = p3dx();
const RobotBody kBody = robot_body(kRobot.footprint, kRobot.limits, kRobot.laser, 0.6);
const NearReturns kNothing;

/// A robot at rest among seven walls drawn at random, with nobody about.
struct StaticMoment {
  explicit StaticMoment(std::uint32_t seed) : random(seed) {
    for (int k = 0; k < 7; ++k) {
      const Vec2 from = place(4.5);
      ground.wall(from, from + direction(in(-kPi, kPi)) * in(0.3, 3.0));
    }
    const Vec2 robot = place(4.0), wanted = place(4.0);
    guide = &ground.towards(robot, wanted);
    start = {static_cast<float>(robot.x), static_cast<float>(robot.y), static_cast<float>(in(-kPi, kPi))};
    goal = {static_cast<float>(wanted.x), static_cast<float>(wanted.y)};
  }

  [[nodiscard]] Situation situation() const { return {{start, goal}, kBody, *guide, *futures, kNothing, 0.24F}; }
  [[nodiscard]] bool has_way_and_room() const {
    const bool has_room =
        kBody.to_walls.clearance(*guide, start.x, start.y, cell::heading_at(start.heading)) > motion::price::kContactM;
    return has_room && situation().time_to_go(start) < Guide::kNoWay_s && !situation().is_at_goal(start);
  }

  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec2 place(double within) { return {1.0 + in(-within, within), 1.0 + in(-within, within)}; }

  std::mt19937 random;
  test::Guided ground;
  std::unique_ptr<Futures> futures = std::make_unique<Futures>();
  const Guide* guide = nullptr;
  RobotState start;
  Place goal;
};

/// s: by how much the best trajectory that sets out at once is cheaper than the best that stands for 0.8 s at least.
float waiting_costs(const Situation& situation) {
  float goes = 1e9F, waits = 1e9F;
  Trajectory tried;
  TrajectoryProposals(situation, 0.0F).each(tried, [&](const Trajectory& trajectory) {
    RobotState driven[kSteps];
    const float cost = trajectory_cost(situation, trajectory, 1e9F, driven).total();
    const bool stands = driven[7].v == 0.0F && driven[7].heading == situation.start.heading;
    float& best = stands ? waits : goes;
    best = std::min(best, cost);
  });
  return waits - goes;
}

}  // namespace

TEST_CASE("with nobody about waiting gains nothing, in two hundred random places") {
  int places = 0;
  for (std::uint32_t seed = 1; places < 200; ++seed) {
    const StaticMoment moment(seed);
    if (!moment.has_way_and_room()) continue;
    ++places;
    INFO("seed " << seed);
    CHECK(waiting_costs(moment.situation()) > -0.1F);
  }
}
