// A ROS 2 robot's messages as its program reads them, and its commands.
#include "apps/formats/ros_robot.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::exchange;
using namespace std::chrono_literals;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
const DriveModel kDrive{.wheel_radius_m = 0.1, .track_width_m = 0.4, .max_wheel_speed_radps = 10.0};

const LaserModel kLaser{.robot_from_laser = {}, .fov_rad = kPi, .beams = 5, .rate_hz = 10.0, .range_max_m = 12.0};

/// Stamped a millisecond after the one before.
ScanMessage half_turn(std::vector<float> ranges) {
  static Time stamp{1'800'000'000s};
  stamp += 1ms;
  const double step = kPi / (static_cast<double>(ranges.size()) - 1.0);
  return {{.stamp = stamp},  "", static_cast<float>(-kPi / 2.0), static_cast<float>(step), 0.01F, 0.1F, 10.0F,
          std::move(ranges), {}};
}

OdometryMessage odometry_at(double x, double y, double heading, Twist2 twist = {}) {
  return {{}, "", {x, y, heading}, twist};
}

double rad(std::uint32_t angle) { return ros::kAngle_rad * static_cast<std::int32_t>(angle); }

}  // namespace

TEST_CASE("a ROS scan has the model's beams, the nearer hit of two, the one beside where there is none") {
  ScanFeed feed(kLaser);
  const auto same = feed.take(half_turn({1, 2, 3, kInfinity, kNan}), Time{5s});
  REQUIRE(same->beam_count == 5);
  CHECK(same->first_angle_rad == Approx(-kPi / 2.0));
  CHECK(same->angle_step_rad == Approx(kPi / 4.0));
  CHECK(same->range_m[0] == 1.0F);
  CHECK(same->range_m[3] == kInfinity);
  CHECK(std::isnan(same->range_m[4]));
  const auto finer = feed.take(half_turn({1, 5, 2, 5, 3, 5, 4, 0.5F, 5}), Time{5100ms});
  REQUIRE(finer->beam_count == 5);
  CHECK(finer->range_m[0] == 1.0F);
  CHECK(finer->range_m[4] == 0.5F);
  const auto coarser = feed.take(half_turn({1, 2, 3}), Time{5200ms});
  REQUIRE(coarser->beam_count == 5);
  CHECK(coarser->range_m[2] == 2.0F);
  CHECK(coarser->range_m[4] == 3.0F);
  CHECK_FALSE(std::isnan(coarser->range_m[3]));
}

TEST_CASE("a ROS scan is stamped at its first beam, its sweep is one period at most") {
  ScanFeed feed(kLaser);
  ScanMessage scan = half_turn({1, 2, 3, 4, 5});
  const auto stamp_s = [&](Duration arrival) {
    return static_cast<double>(feed.take(scan, Time{arrival})->stamp_ns) * 1e-9;
  };
  CHECK(stamp_s(5s) == Approx(4.96).margin(1e-6));
  scan.stamp += 100ms;
  CHECK(stamp_s(5s + 130ms) == Approx(5.06).margin(1e-4));  // 30 ms longer under way
  scan.beam_step_s = 1.0F;
  scan.stamp += 100ms;
  CHECK(feed.take(scan, Time{5s + 200ms})->sweep_ns == std::chrono::nanoseconds(100ms).count());
  for (const float none : {kNan, -1.0F, 0.0F}) {
    scan.beam_step_s = none;
    scan.stamp += 100ms;
    CHECK(feed.take(scan, Time{6s})->sweep_ns == 0);
  }
}

TEST_CASE("what is no scan has no beams") {
  ScanFeed feed(kLaser);
  CHECK(feed.take(half_turn({}), Time{5s})->beam_count == 0);
  CHECK(feed.take(half_turn({1, 2}), Time{5s})->beam_count == 0);
  const auto with = [&](auto change) {
    ScanMessage scan = half_turn({1, 2, 3, 4, 5});
    change(scan);
    return feed.take(scan, Time{5s})->beam_count;
  };
  for (const float bad : {kNan, kInfinity, 1e9F}) {
    CHECK(with([bad](auto& s) { s.first_angle_rad = bad; }) == 0);
    CHECK(with([bad](auto& s) { s.angle_step_rad = bad; }) == 0);
  }
  CHECK(with([](auto& s) { s.angle_step_rad = 0.0F; }) == 0);
  for (const float bad : {kNan, 0.0F}) CHECK(with([bad](auto& s) { s.range_max_m = bad; }) == 0);
  CHECK(with([](auto& s) { s.range_min_m = -0.01F; }) == 5);  // as some drivers have it
  CHECK(with([](auto& s) { s.range_max_m = kInfinity; }) == 5);
}

TEST_CASE("stamps of any clock tell how long a message was under way, and none that jumps tells a lie") {
  SentTimes times;
  const Time theirs{1'700'000'000s};
  CHECK(times.sent(theirs, Time{10s}) == Time{10s});
  CHECK(times.sent(theirs + 100ms, Time{10s + 100ms}) == Time{10s + 100ms});
  const Time late = times.sent(theirs + 200ms, Time{10s + 500ms}).value();
  CHECK(late < Time{10s + 201ms});
  CHECK(late > Time{10s + 199ms});
  CHECK(times.sent(theirs - 3600s, Time{11s}) == Time{11s});                  // set back
  CHECK(times.sent(theirs + 4000s, Time{11s + 100ms}) == Time{11s + 100ms});  // ahead
  CHECK(times.sent(theirs, Time{11s + 200ms}) == Time{11s + 200ms});
  CHECK(times.sent(Time{}, Time{12s}) == Time{12s});  // not set
  CHECK(times.sent(Time{}, Time{13s}) == Time{13s});
}

TEST_CASE("a message that is repeated or overtaken is none, and one that is late from the start is as old as it is") {
  SentTimes times;
  const Time wall{1'700'000'000s}, ours{100s};
  const auto at = [&](Duration after, Duration age, Duration written = 0s) {
    return times.sent(wall + after - age, {ours + after, wall + after, wall + after - written});
  };
  CHECK(at(0s, 600ms) == ours - 600ms);  // the first of all
  CHECK(at(100ms, 600ms) == ours + 100ms - 600ms);
  CHECK_FALSE(at(200ms, 700ms));  // the same again
  CHECK_FALSE(at(200ms, 900ms));  // an earlier one
  CHECK(at(300ms, 0ms) == ours + 300ms);
  CHECK_FALSE(at(400ms, 600ms));
  CHECK(at(500ms, 0ms, 300ms) == ours + 200ms);  // it lay at its writer
  SentTimes unset;
  CHECK(unset.sent(Time{}, {ours, wall, wall - 400ms}) == ours - 400ms);
  CHECK_FALSE(unset.sent(Time{}, {ours + 1s, wall + 1s, wall - 400ms}));
}

TEST_CASE("a goal that is repeated is one order, another writer's is another, and one that comes late is none") {
  using Heard = GoalOrders::Heard;
  GoalOrders orders;
  const Time wall{1'700'000'000s};
  const auto say = [&](const char* message, std::uint64_t writer, Time stamp, Duration written = 0s) {
    return orders.judge(message, stamp, writer, {kNever, wall, wall - written});
  };
  CHECK(say("a", 1, wall) == Heard::kOrder);
  for (int k = 0; k < 3; ++k) CHECK(say("a", 1, wall) == Heard::kRepeated);
  CHECK(say("a", 2, wall) == Heard::kOrder);
  for (int k = 0; k < 3; ++k) CHECK(say("unstamped", 3, Time{}) == Heard::kOrder);  // the desk tells
  CHECK(say("b", 1, wall - 1s) == Heard::kOrder);
  CHECK(say("a", 1, wall - 3s) == Heard::kLate);
  CHECK(say("c", 1, wall + 3s) == Heard::kLate);
  CHECK(say("d", 1, Time{}, 3s) == Heard::kLate);
  CHECK(say("e", 1, wall, 3s) == Heard::kLate);
  CHECK(say("e", 1, wall) == Heard::kRepeated);  // late once, late for ever
  for (std::uint64_t writer = 10; writer < 1000; ++writer) CHECK(say("e", writer, Time{}) == Heard::kOrder);
}

TEST_CASE("odometry is two wheels of the model's radius and track") {
  OdometryFeed feed(kDrive);
  const auto first = feed.take(odometry_at(3.0, 4.0, 0.0, {0.5, 1.0}), Time{5s});
  REQUIRE(first);
  CHECK(first->stamp == Time{5s});
  // 0.5 m/s less and more 0.2 m of arm times 1 rad/s, over 0.1 m.
  CHECK(first->wheels[0].speed_radps == Approx(3.0F));
  CHECK(first->wheels[1].speed_radps == Approx(7.0F));
  CHECK(first->wheels[0].angle == 0);
  const auto ahead = feed.take(odometry_at(3.2, 4.0, 0.0), Time{5100ms});
  CHECK(rad(ahead->wheels[0].angle) == Approx(2.0));
  CHECK(rad(ahead->wheels[1].angle) == Approx(2.0));
  const auto back = feed.take(odometry_at(3.1, 4.0, 0.0), Time{5200ms});
  CHECK(rad(back->wheels[0].angle) == Approx(1.0));
  const auto turned = feed.take(odometry_at(3.1, 4.0, 0.5), Time{5300ms});  // on the spot: 0.1 m of each wheel
  CHECK(rad(turned->wheels[0].angle) == Approx(0.0).margin(1e-3));
  CHECK(rad(turned->wheels[1].angle) == Approx(2.0));
  static_cast<void>(feed.take(odometry_at(3.1, 4.0, 3.1), Time{5400ms}));
  const auto over = feed.take(odometry_at(3.1, 4.0, -3.1), Time{5500ms});  // by 0.0832 rad, not back
  CHECK(rad(over->wheels[1].angle) == Approx(2.0 + 2.6 * 2.0 + 0.083185 * 2.0).epsilon(1e-4));
}

TEST_CASE("odometry that no robot has is none") {
  OdometryFeed feed(kDrive);
  for (const double bad : {std::nan(""), 1e256, -HUGE_VAL}) {
    CHECK_FALSE(feed.take(odometry_at(bad, 0, 0), Time{5s}));
    CHECK_FALSE(feed.take(odometry_at(0, bad, 0), Time{5s}));
    CHECK_FALSE(feed.take(odometry_at(0, 0, bad), Time{5s}));
    CHECK_FALSE(feed.take(odometry_at(0, 0, 0, {bad, 0}), Time{5s}));
    CHECK_FALSE(feed.take(odometry_at(0, 0, 0, {0, bad}), Time{5s}));
  }
  CHECK(feed.take(odometry_at(0, 0, 0), Time{5s}));
}

TEST_CASE("two wheels' speeds are a twist, and none beyond what the wheels can do") {
  const auto twist = twist_of(3.0, 7.0, kDrive);
  REQUIRE(twist);
  CHECK(twist->v_mps == Approx(0.5));
  CHECK(twist->w_radps == Approx(1.0));
  CHECK(twist_of(-10.0, 10.0, kDrive));
  CHECK_FALSE(twist_of(10.1, 0.0, kDrive));
  CHECK_FALSE(twist_of(0.0, std::nan(""), kDrive));
  CHECK_FALSE(twist_of(HUGE_VAL, 0.0, kDrive));
}
