// Two scanners: each is judged by itself, and what they prove is what they prove together.
#include <functional>

#include "firmware/safety/supervisor.h"
#include "tests/safety/trial_room.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// A wheelchair with a scanner of 270 degrees at its front, and one at its rear where asked for.
RobotModel chair(bool rear) {
  RobotModel model = wheelchair();
  model.laser.robot_from_laser = {0.70, 0.0, 0.0};
  if (!rear) return model;
  LaserModel other = model.laser;
  other.robot_from_laser = {-0.30, 0.0, kPi};
  other.rate_hz = 10.0;
  REQUIRE(model.other_lasers.push_back(other));
  return model;
}

constexpr trials::Wall kHall[] = {{{-11.0, -4.0}, {11.0, -4.0}},
                                  {{-11.0, 4.0}, {11.0, 4.0}},
                                  {{10.0, -5.0}, {10.0, 5.0}},
                                  {{-10.0, -5.0}, {-10.0, 5.0}}};

/// A robot that stands in a hall of 20 m x 8 m, whatever it is permitted.
struct Stand {
  RobotModel model;
  Supervisor supervisor;
  Time now = time_from_seconds(1.0);
  LaserScan front;
  std::vector<LaserScan> others;
  WheelState wheels{.sequence = 1};
  OperatorInput input;
  /// What becomes of a scanner's new scan before it is judged; false: it does not come.
  std::function<bool(LaserScan&)> spoil = [](LaserScan&) { return true; };
  /// In the robot's frame; none where it is far away.
  trials::Walker post{{100.0, 0.0}, {}, 0.1};

  explicit Stand(const RobotModel& robot) : model(robot), supervisor({.model = robot, .latches_all = true}) {
    others.resize(robot.other_lasers.size());
    input.has_goal = true;
    input.reset = true;
    tick({});
    input.reset = false;
  }
  Verdict tick(const Twist2& wanted) {
    now += std::chrono::milliseconds(20);
    see(0, front);
    for (std::size_t k = 0; k < others.size(); ++k) see(k + 1, others[k]);
    wheels.stamp = now, ++wheels.sequence;
    return supervisor.judge(wanted, {{front, others}, wheels, input, now, now});
  }
  Verdict ticks(int count, const Twist2& wanted) {
    Verdict verdict;
    for (int k = 0; k < count; ++k) verdict = tick(wanted);
    return verdict;
  }
  void see(std::size_t scanner, LaserScan& into) const {
    const LaserModel& laser = model.lasers()[scanner];
    if (into.sequence > 0 && to_seconds(now - into.stamp) < 1.0 / laser.rate_hz - 1e-6) return;
    LaserScan scan;
    scan.scanner = static_cast<std::uint8_t>(scanner);
    scan.stamp = now, scan.sequence = into.sequence + 1;
    tests::lay_beams(scan, laser);
    for (std::size_t k = 0; k < scan.beam_count; ++k) {
      const Vec2 along = direction(laser.robot_from_laser.heading + scan.angle_rad(k));
      scan.range_m[k] = static_cast<float>(trials::range(kHall, {&post, 1}, laser.robot_from_laser.position(), along));
    }
    if (spoil(scan)) into = scan;
  }
};

constexpr Twist2 kBack{-0.5, 0.0}, kAhead{0.5, 0.0};

}  // namespace

TEST_CASE("backward it goes slowly where one scanner looks ahead, and as fast as wanted where another looks back") {
  const Verdict one = Stand(chair(false)).ticks(100, kBack);
  CHECK(one.permitted.v_mps == Approx(-0.3));
  CHECK(has(one.reasons, Reason::kUnwatched));
  const Verdict two = Stand(chair(true)).ticks(100, kBack);
  CHECK(two.permitted.v_mps == Approx(-0.5));
  CHECK(two.reasons == Reason::kNone);
  CHECK(two.faulty_scanners == 0);
}

TEST_CASE("what only the rear scanner sees stops it on its way back") {
  const bool rear = GENERATE(false, true);
  Stand stand(chair(rear));
  stand.post.centre = {-0.35 - 0.1 - 0.05, 0.0};  // its rim 5 cm behind the body
  const Verdict verdict = stand.ticks(60, kBack);
  CHECK(has(verdict.reasons, Reason::kStopZone) == rear);
  INFO(verdict.permitted.v_mps << " m/s: " << to_string(verdict.reasons));
  CHECK((verdict.permitted.v_mps > -0.11) == rear);
}

TEST_CASE("one of two scanners that falls silent, is blinded, or shows nothing is a fault that names it") {
  const int lost = GENERATE(0, 1);
  const bool silent = GENERATE(true, false);
  Stand stand(chair(true));
  CHECK(stand.ticks(50, kAhead).permitted.v_mps == 0.5);
  stand.spoil = [&](LaserScan& scan) {
    if (scan.scanner != lost) return true;
    scan.range_m.fill(0.0F);
    return !silent;
  };
  const Verdict verdict = stand.ticks(50, kAhead);
  CHECK(has(verdict.reasons, silent ? Reason::kScanStale : Reason::kScanInvalid));
  CHECK(has(verdict.reasons, Reason::kLatched));
  CHECK(verdict.permitted.v_mps == 0.0);
  CHECK(verdict.faulty_scanners == (1U << lost));
  CHECK(to_string(verdict.reasons, verdict.faulty_scanners).ends_with(lost == 0 ? "|scanner_1" : "|scanner_2"));
}

TEST_CASE("it does not set out before each of its scanners has been seen") {
  Stand stand(chair(true));
  stand.spoil = [](LaserScan& scan) { return scan.scanner == 0; };
  stand.others[0] = {};
  const Verdict verdict = stand.ticks(50, kAhead);
  CHECK(verdict.permitted.v_mps == 0.0);
  CHECK(has(verdict.reasons, Reason::kScanStale));
  CHECK(verdict.faulty_scanners == 2U);
}

TEST_CASE("it reckons with the slower of its scanners") {
  const auto free_way_m = [](double rear_hz) {
    RobotModel model = chair(true);
    model.other_lasers[0].rate_hz = rear_hz;
    Stand stand(model);
    stand.post.centre = {0.75 + 0.1 + 0.3, 0.0};
    return stand.ticks(40, kAhead).permitted.v_mps;
  };
  CHECK(free_way_m(5.0) < free_way_m(15.0) - 0.05);
}
