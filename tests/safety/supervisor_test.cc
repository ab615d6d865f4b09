#include "tests/safety/supervisor_bench.h"

using namespace jaywalk;
using namespace jaywalk::supervised;

TEST_CASE("a speed zone's limit holds either way, on the same arc, with its reason") {
  Bench bench;
  bench.most_speed_mps = 0.2;
  const Verdict ahead = bench.tick({0.5, 0.3});
  CHECK(ahead.permitted == Twist2{0.2, 0.3 * 0.2 / 0.5});
  CHECK(ahead.reasons == Reason::kSpeedZone);
  Bench back;
  back.most_speed_mps = 0.1;
  CHECK(back.tick({-0.2, 0.0}).permitted == Twist2{-0.1, 0.0});
  CHECK(back.tick({0.0, 0.5}).reasons == Reason::kNone);  // turning on the spot is not driving through
}

TEST_CASE("a scan older than two and a half periods, two that were lost, stops the robot") {
  Bench bench;
  bench.tick({0.5, 0.0});
  bench.scan_fresh = false;  // 15 Hz: 167 ms, that is eight ticks
  CHECK(bench.ticks(8, {0.5, 0.0}).reasons == Reason::kNone);
  CHECK(has(bench.tick({0.5, 0.0}).reasons, Reason::kScanStale));
  CHECK(bench.ticks(40, {0.5, 0.0}).permitted == Twist2{});
  bench.scan_fresh = true;
  CHECK(bench.tick({0.1, 0.0}).permitted.v_mps == 0.1);  // a limit of communication inside the machine: not latched
}

TEST_CASE("stopping never brakes harder than the drive: 1 m/s2 is 0.02 m/s a tick") {
  Bench bench;
  bench.tick({0.5, 0.0});
  bench.input.emergency_stop = true;
  CHECK(bench.tick({0.5, 0.0}).permitted.v_mps == Approx(0.48));
  CHECK(bench.tick({0.5, 0.0}).permitted.v_mps == Approx(0.46));
}

TEST_CASE("what is old, stamped ahead of now or no number stops the robot and says what it is") {
  using namespace std::chrono_literals;
  struct Row {
    const char* name;
    void (*spoil)(Bench&);
    Reason reason;
    int ticks = 1;
  };
  const Row rows[] = {
      {"old wheels", [](Bench& b) { b.wheels_fresh = false; }, Reason::kWheelsStale, 4},
      {"a scan that says it took minutes", [](Bench& b) { b.scan_fresh = false, b.scan.sweep = 5min; },
       Reason::kScanStale, 30},
      {"a scan from ahead", [](Bench& b) { b.scan_fresh = false, b.scan.stamp += 1s; }, Reason::kScanStale, 2},
      {"wheels from ahead", [](Bench& b) { b.wheels_fresh = false, b.wheels.stamp += 1s; }, Reason::kWheelsStale},
      {"a plan from ahead", [](Bench& b) { b.plan_fresh = false, b.plan_stamp += 1s; }, Reason::kPlanStale},
      {"a scan's first angle", [](Bench& b) { b.scan.first_angle_rad = std::nanf(""); }, Reason::kScanInvalid},
      {"a scan's step", [](Bench& b) { b.scan.angle_step_rad = std::nanf(""); }, Reason::kScanInvalid},
      {"a wheel's angle", [](Bench& b) { b.wheels.left_rad = std::nan(""); }, Reason::kWheelsInvalid}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    Bench bench;
    row.spoil(bench);
    const Verdict verdict = bench.ticks(row.ticks, {0.5, 0.0});
    CHECK(has(verdict.reasons, row.reason));
    if (row.reason == Reason::kWheelsInvalid) CHECK(verdict.permitted == Twist2{});
  }
  const Verdict verdict = Bench().tick({std::nan(""), 0.0});
  CHECK(has(verdict.reasons, Reason::kNotFinite));
  CHECK(verdict.permitted == Twist2{});
}

TEST_CASE("wheels that are stamped ahead by what a late loop may see are no fault") {
  Bench late;
  late.wheels_fresh = false;
  late.wheels.stamp += std::chrono::milliseconds(60);
  CHECK(late.tick({0.5, 0.0}).reasons == Reason::kNone);
}

TEST_CASE("an ageing plan slows the robot to a stop: half speed at 0.65 s, none at 1 s") {
  Bench bench;
  bench.tick({0.6, 0.0});
  bench.plan_fresh = false;
  CHECK(bench.ticks(15, {0.6, 0.0}).permitted.v_mps == 0.6);  // 0.3 s
  const Verdict halfway = bench.ticks(17, {0.6, 0.0});        // 0.64 s
  CHECK(halfway.permitted.v_mps == Approx(0.6 * 0.36 / 0.7));
  CHECK(has(halfway.reasons, Reason::kPlanStale));
  CHECK(bench.ticks(20, {0.6, 0.0}).permitted.v_mps == 0.0);
}

TEST_CASE("a plan that stays as old takes a share of the limits, and no more of it with every tick") {
  Bench bench;
  bench.plan_fresh = false;
  double v_mps = 0.0;
  for (int k = 0; k < 200; ++k) {
    bench.plan_stamp = bench.now - std::chrono::milliseconds(630);  // 650 at the tick
    v_mps =
        bench.tick({std::min(v_mps + 0.01, 0.6), 0.0}).permitted.v_mps;  // a follower's ramp from what was permitted
  }
  CHECK(v_mps == Approx(0.6 * 0.35 / 0.7));
}

TEST_CASE("hard braking keeps to the arc that the stop zone looked along") {
  Bench bench;
  bench.ticks(5, {0.5, 0.4});
  for (int k = 0; k < 10; ++k) {
    const Twist2 twist = bench.tick({0.1, 0.0}).permitted;
    CHECK(twist.v_mps < 0.5);
    CHECK(twist.w_radps == Approx(0.8 * twist.v_mps));
  }
}

TEST_CASE("a wall ahead lets the robot come near only as slowly as it can stop") {
  Bench bench;
  bench.scan.range_m.fill(INFINITY);
  bench.scan.range_m[405] = 0.5F;  // dead ahead: 0.5 - 0.21 - 0.08 = 0.21 m free
  const Verdict verdict = bench.ticks(60, {0.6, 0.0});
  CHECK(has(verdict.reasons, Reason::kStopZone));
  CHECK(verdict.permitted.v_mps > 0.0);
  // v t + v^2/2b = 0.21 with t = 0.1 + 0.08 s, b = 1: v = sqrt(0.0324 + 0.42) - 0.18 = 0.4926.
  CHECK(verdict.permitted.v_mps == Approx(0.4926).epsilon(1e-3));
  bench.scan.range_m[405] = 0.26F;
  CHECK(bench.ticks(60, {0.6, 0.0}).permitted.v_mps == 0.0);
}

TEST_CASE("slow drives, slow ticks and an old scan each cost their way, and no more than is reckoned with") {
  // 0.21 m are free, as above: v = sqrt(t^2 + 0.42) - t for a reaction time of t and 1 m/s2.
  const auto speed_for = [](const MeasuredLatency& latency, int old_ticks = 0) {
    Bench bench;
    bench.latency = latency;
    bench.scan.range_m.fill(INFINITY);
    bench.scan.range_m[405] = 0.5F;
    bench.ticks(60, {0.6, 0.0});
    bench.scan_fresh = false;
    return bench.ticks(1 + old_ticks, {0.6, 0.0}).permitted.v_mps;
  };
  const auto reckoned = [](double t_s) { return std::sqrt(t_s * t_s + 0.42) - t_s; };
  CHECK(speed_for({}) == Approx(reckoned(0.18)).epsilon(1e-3));
  CHECK(speed_for({0.001, 0.02}) == Approx(reckoned(0.18)).epsilon(1e-3));
  CHECK(speed_for({0.015, 0.15}) == Approx(reckoned(0.1 + 0.02 + 0.015 + 0.15)).epsilon(1e-3));
  CHECK(speed_for({5.0, 5.0}) == Approx(reckoned(0.1 + 0.02 + 0.1 + 0.3)).epsilon(1e-3));
  CHECK(speed_for({}, 7) == Approx(reckoned(0.16 + 0.08)).epsilon(1e-3));  // eight ticks old
}

TEST_CASE("a blinded scanner stops the robot at once: more than half of its beams prove nothing") {
  const float nothing = GENERATE(NAN, 0.0F, -1.0F, 0.01F, -INFINITY);
  Bench bench;
  for (std::size_t beam = 0; beam < 405; ++beam) bench.scan.range_m[beam] = nothing;
  CHECK_FALSE(has(bench.tick({-0.1, 0.0}).reasons, Reason::kSightLost));
  bench.scan.range_m[405] = nothing;
  CHECK(has(bench.tick({-0.1, 0.0}).reasons, Reason::kSightLost));
}

TEST_CASE("more than a third of the beams ahead lost for longer than a second is a fault, a moment is none") {
  // 360 beams lie within 60 degrees of ahead, and one in the middle: 121 are more than a third.
  Bench bench;
  for (std::size_t beam = 345; beam < 466; ++beam) bench.scan.range_m[beam] = 0.0F;
  CHECK_FALSE(has(bench.ticks(51, {}).reasons, Reason::kSightLost));
  CHECK(has(bench.tick({}).reasons, Reason::kSightLost));
  bench.scan.range_m[345] = 10.0F;
  CHECK_FALSE(has(bench.ticks(100, {}).reasons, Reason::kSightLost));
  bench.scan.range_m[345] = 0.0F;
  CHECK_FALSE(has(bench.ticks(51, {}).reasons, Reason::kSightLost));
}

TEST_CASE("two beams are no scanner, one that finds nothing in reach is") {
  Bench bench;
  bench.scan.range_m.fill(0.0F);
  CHECK(has(bench.tick({0.5, 0.0}).reasons, Reason::kScanInvalid));
  bench.scan.range_m.fill(std::numeric_limits<float>::infinity());
  CHECK_FALSE(has(bench.tick({0.5, 0.0}).reasons, Reason::kScanInvalid));
  bench.scan.range_m.fill(0.0F);
  bench.scan.range_m[405] = bench.scan.range_m[100] = 5.0F;
  CHECK(has(bench.tick({0.5, 0.0}).reasons, Reason::kScanInvalid));
  bench.scan.range_m[200] = 5.0F;
  CHECK_FALSE(has(bench.tick({0.5, 0.0}).reasons, Reason::kScanInvalid));
}

TEST_CASE("a beam that ends on the body itself forbids every motion, and is told apart from what stands in the way") {
  Bench bench;
  bench.scan.range_m[405] = 0.15F;  // straight ahead; the P3-DX ends at 0.21
  for (const Twist2 wanted : {Twist2{0.1, 0.0}, Twist2{-0.1, 0.0}, Twist2{0.0, 0.3}}) {
    const Verdict verdict = bench.tick(wanted);
    CHECK(verdict.permitted == Twist2{});
    CHECK(has(verdict.reasons, Reason::kStopZone));
    CHECK(has(verdict.reasons, Reason::kTouched));
  }
  bench.scan.range_m[405] = 0.25F;  // before it
  const Verdict verdict = bench.tick({0.1, 0.0});
  CHECK(verdict.permitted == Twist2{});
  CHECK_FALSE(has(verdict.reasons, Reason::kTouched));
}

TEST_CASE("too fast is slowed along the same curve") {
  Bench bench;
  const Verdict verdict = bench.tick({1.2, 0.5});
  CHECK(verdict.permitted.v_mps == Approx(0.6));
  CHECK(verdict.permitted.w_radps == Approx(0.25));
  CHECK(to_string(verdict.reasons) == "speed_limit");
}

TEST_CASE("trouble of bus or drive stops, says which, and is latched until a reset") {
  const auto [trouble, reason] =
      GENERATE(std::pair{DriveTrouble::kBusUnwell, Reason::kBus}, std::pair{DriveTrouble::kBusRefused, Reason::kBus},
               std::pair{DriveTrouble::kDriveSilent, Reason::kDrive});
  Bench bench;
  bench.tick({0.3, 0.0});
  bench.wheels.trouble = trouble;
  CHECK(bench.tick({0.3, 0.0}).reasons == (reason | Reason::kLatched));
  CHECK(bench.ticks(30, {0.3, 0.0}).permitted == Twist2{});
  bench.reset();  // the trouble is still there
  CHECK(bench.tick({0.3, 0.0}).permitted == Twist2{});
  bench.wheels.trouble = DriveTrouble::kNone;
  CHECK(bench.ticks(30, {0.3, 0.0}).reasons == Reason::kLatched);
  bench.reset();
  CHECK(bench.tick({0.01, 0.0}).permitted.v_mps == 0.01);
}

TEST_CASE("one missed tick is nothing, two in a row, or every other one, stop the robot until a reset") {
  Bench bench;
  bench.tick({0.3, 0.0});
  bench.now += std::chrono::milliseconds(20);  // with tick's own 20 ms: one of 50 Hz did not happen
  CHECK(bench.tick({0.3, 0.0}).reasons == Reason::kNone);
  CHECK(bench.ticks(5, {0.3, 0.0}).reasons == Reason::kNone);
  bench.now += std::chrono::milliseconds(40);
  CHECK(bench.tick({0.3, 0.0}).reasons == (Reason::kMissedTicks | Reason::kLatched));
  CHECK(bench.ticks(30, {0.3, 0.0}).reasons == Reason::kLatched);
  bench.reset();
  CHECK(bench.tick({0.01, 0.0}).permitted.v_mps == 0.01);
  bench.now += std::chrono::milliseconds(20);
  bench.tick({0.3, 0.0});
  bench.now += std::chrono::milliseconds(20);
  CHECK(has(bench.tick({0.3, 0.0}).reasons, Reason::kMissedTicks));
}

TEST_CASE("on wires scans that were lost and come again wait for a reset") {
  Bench bench(true);
  bench.tick({0.3, 0.0});
  bench.scan_fresh = false;
  bench.ticks(9, {0.3, 0.0});
  bench.scan_fresh = true;
  CHECK(bench.ticks(30, {0.3, 0.0}).reasons == Reason::kLatched);
  bench.reset();
  CHECK(bench.tick({0.01, 0.0}).permitted.v_mps == 0.01);
}

TEST_CASE("on wires what has not been there yet stops and does not latch") {
  Bench bench(true);
  bench.scan.sequence = 0;
  bench.scan.stamp = kNever;
  bench.scan_fresh = false;
  CHECK(has(bench.ticks(5, {}).reasons, Reason::kScanStale));
  CHECK(bench.supervisor.mode() != Mode::kLatched);
}

TEST_CASE("a scan is as old as its last beam, and the stop zone reckons with its first") {
  Bench bench;
  bench.scan.range_m.fill(INFINITY);
  bench.scan.range_m[405] = 0.5F;
  const double at_once = bench.ticks(60, {0.6, 0.0}).permitted.v_mps;
  bench.scan.sweep = std::chrono::milliseconds(50);
  CHECK(bench.ticks(60, {0.6, 0.0}).permitted.v_mps < at_once - 0.01);
  bench.scan_fresh = false;
  CHECK_FALSE(has(bench.ticks(10, {0.1, 0.0}).reasons, Reason::kScanStale));  // 200 ms after its first beam
  CHECK(has(bench.tick({0.1, 0.0}).reasons, Reason::kScanStale));
}

// What a reset waits for.

TEST_CASE("an emergency stop is latched until a reset edge at zero setpoint with the button out") {
  Bench bench;
  bench.input.emergency_stop = true;
  bench.ticks(3, {0.5, 0.0});
  bench.input.reset = true;  // pressed while the button is in: no edge later counts from this
  bench.tick({});
  bench.input.emergency_stop = false;
  CHECK(has(bench.ticks(3, {0.5, 0.0}).reasons, Reason::kLatched));
  bench.input.reset = false;
  bench.tick({});
  bench.input.reset = true;
  CHECK(has(bench.tick({0.5, 0.0}).reasons, Reason::kLatched));  // an edge, but not at zero
  bench.input.reset = false;
  bench.tick({});
  bench.input.reset = true;
  bench.tick({});
  CHECK(bench.supervisor.mode() != Mode::kLatched);
  CHECK(bench.tick({0.01, 0.0}).permitted.v_mps == 0.01);
}

TEST_CASE("a pose in doubt is latched, and no reset moves the robot before it is known") {
  Bench bench;
  bench.ticks(30, {0.5, 0.0});
  bench.pose_doubtful = true;
  bench.ticks(50, {0.5, 0.0});
  bench.reset();
  const Verdict verdict = bench.ticks(10, {0.5, 0.0});
  CHECK(verdict.permitted == Twist2{});
  CHECK(verdict.reasons == (Reason::kPoseDoubtful | Reason::kLatched));
  bench.pose_doubtful = false;
  CHECK(bench.ticks(10, {0.5, 0.0}).permitted == Twist2{});
  bench.reset();
  CHECK(bench.ticks(10, {0.5, 0.0}).permitted.v_mps > 0.0);
}

TEST_CASE("no reset counts while the stick is out of its middle: nothing drives off with it") {
  Bench bench;
  bench.input.has_goal = false;
  bench.input.steers = true;
  bench.input.emergency_stop = true;
  bench.ticks(3, {});
  bench.input.emergency_stop = false;
  bench.input.stick = {1.0, 0.0};
  bench.input.reset = true;
  CHECK(has(bench.ticks(3, {}).reasons, Reason::kLatched));
  bench.input.reset = false;
  bench.input.stick = {};
  bench.tick({});
  bench.input.reset = true;
  bench.tick({});
  bench.input.stick = {0.5, 0.0};
  CHECK(bench.tick({0.01, 0.0}).permitted.v_mps == 0.01);
  CHECK(bench.supervisor.mode() == Mode::kDriving);
  bench.input.stick = {};
  CHECK(has(bench.tick({}).reasons, Reason::kNoGoal));
}
