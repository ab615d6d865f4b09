#include "apps/report/drive_metrics.h"

#include <cmath>
#include <limits>

#include "apps/report/csv_file.h"
#include "apps/report/loop_count.h"
#include "apps/report/trails.h"
#include "apps/report/waits.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

TEST_CASE("a straight drive has its length and only small turns") {
  // 2 m in steps of 0.03 m: 66 of them and one of 0.02 m; marks at 0.25 .. 2.0 (the last may miss by
  // rounding) have turns at all but the first.
  PathShape shape;
  for (int i = 0; i <= 66; ++i) shape.add({0.03 * i, 1.0});
  shape.add({2.0, 1.0});
  shape.add({2.01, 1.0});
  CHECK(shape.length_m() == Approx(2.01));
  CHECK(shape.max_turn_deg() == Approx(0.0).margin(1e-9));
  CHECK(shape.turn_histogram()[0] == 7);
}

TEST_CASE("a right angle at a mark is a turn of 90 degrees, in the tenth bin") {
  PathShape shape;
  shape.add({0, 0});
  shape.add({0.5, 0});
  shape.add({0.5, 0.5});
  CHECK(shape.length_m() == Approx(1.0));
  CHECK(shape.max_turn_deg() == Approx(90.0));
  // Marks at 0.25, 0.5, 0.75, 1.0 m of travel: turns of 0, 90 and 0 degrees.
  CHECK(shape.turn_histogram()[0] == 2);
  CHECK(shape.turn_histogram()[9] == 1);
}

TEST_CASE("a circle of one metre turns by about 0.25 rad a mark") {
  // 0.25 m of travel on a circle of radius 1 m is 0.25 rad = 14.3 degrees: bin 1.
  PathShape shape;
  for (int i = 0; i <= 6283; ++i) shape.add(direction(0.001 * i));
  CHECK(shape.length_m() == Approx(6.283).epsilon(1e-4));
  CHECK(shape.max_turn_deg() == Approx(14.32).epsilon(0.01));
  CHECK(shape.turn_histogram()[1] == 24);  // 25 marks in 6.283 m, the first without a turn
}

TEST_CASE("turning back is a turn of 180 degrees, in the last bin") {
  PathShape shape;
  for (const double x : {0.0, 0.5, 0.0}) shape.add({x, 0});
  CHECK(shape.max_turn_deg() == Approx(180.0));
  CHECK(shape.turn_histogram()[kTurnBins - 1] == 1);
}

TEST_CASE("standing still adds nothing") {
  PathShape shape;
  for (int i = 0; i < 10; ++i) shape.add({1, 1});
  CHECK(shape.length_m() == 0.0);
  CHECK(shape.max_turn_deg() == 0.0);
}

TEST_CASE("a steady acceleration is measured exactly and its jerk is that of its ends") {
  // 0.5 m/s^2 from 1 s to 3 s at 50 Hz. The windows of 0.1 s climb from 0 to 0.5 m/s^2 within 0.1 s,
  // so the greatest jerk is 0.5 / 0.1 = 5 m/s^3.
  Smoothness smoothness;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.02 * i;
    smoothness.add(Time{Duration{20'000'000LL * i}}, t < 1 ? 0.0 : t < 3 ? 0.5 * (t - 1) : 1.0);
  }
  CHECK(smoothness.accel_max_mps2() == Approx(0.5));
  CHECK(smoothness.jerk_quantile_mps3(1.0) == Approx(5.0));
  CHECK(smoothness.jerk_quantile_mps3(0.5) == Approx(0.0).margin(1e-9));
}

TEST_CASE("braking counts as much as speeding up") {
  Smoothness smoothness;
  for (int i = 0; i <= 50; ++i) smoothness.add(Time{Duration{20'000'000LL * i}}, 1.0 - 0.02 * i);
  CHECK(smoothness.accel_max_mps2() == Approx(1.0));
}

TEST_CASE("before a window is full there is no acceleration to tell") {
  Smoothness smoothness;
  smoothness.add(Time{Duration{0}}, 0.0);
  smoothness.add(Time{Duration{20'000'000}}, 9.0);
  CHECK(std::isnan(smoothness.accel_max_mps2()));
}

TEST_CASE("quantiles are of the nearest rank") {
  // Of 1 .. 200 the median is the 100th, the 99 % quantile the 198th.
  Distribution d;
  CHECK(std::isnan(d.quantile(0.5)));
  for (int i = 200; i > 0; --i) d.add(i);
  CHECK(d.quantile(0.5) == 100);
  CHECK(d.quantile(0.99) == 198);
  CHECK(d.max() == 200);
}

TEST_CASE("cells have six decimals, no sign of zero, and are empty for NaN") {
  CHECK(csv_cell(1.0 / 3) == "0.333333");
  CHECK(csv_cell(-0.0) == "0.000000");
  CHECK(csv_cell(-4e-7) == "0.000000");
  CHECK(csv_cell(-6e-7) == "-0.000001");
  CHECK(csv_cell(std::numeric_limits<double>::quiet_NaN()).empty());
  CHECK(csv_cell(-std::numeric_limits<double>::infinity()) == "-inf");
  CHECK(csv_cell(1e300).size() == 308);  // 301 digits, a point, six decimals
}

TEST_CASE("seconds are rounded from the nanosecond, before the epoch too") {
  const Scratch scratch;
  {
    CsvFile csv(scratch.path("t.csv"), "t_s");
    for (const std::int64_t ns :
         {0LL, 1'403'024'474'631'778'048LL, 20'000'499LL, 20'000'500LL, -1'500LL, -2'500'000'000LL}) {
      csv.seconds(Time{Duration{ns}}).end_row();
    }
  }
  CHECK(scratch.read("t.csv") == "t_s\n0.000000\n1403024474.631778\n0.020000\n0.020001\n-0.000001\n-2.500000\n");
}

TEST_CASE("trails are thinned to a point every 0.2 s and ordered by id") {
  TrailBook book;
  for (int i = 0; i <= 50; ++i) {
    const Time t{Duration{20'000'000LL * i}};
    book.add(7, t, {0.01 * i, 0}, 0.3, i == 20);
    book.add(3, t, {0, 0}, 0.2, false);
  }
  const auto trails = book.trails();
  REQUIRE(trails.size() == 2);
  CHECK(trails[0].id == 3);
  CHECK(trails[1].points.size() == 6);  // at 0, 0.2, .. 1.0 s
  CHECK(trails[1].flagged);
}

/// Loops of a drive at a steady turn: `turned_rad` in all on circles of this radius, the goal nearer by so much a
/// second.
std::size_t loops_of(double radius_m, double turned_rad, double nearer) {
  constexpr double kStep_rad = 0.02, kMps = 0.5;
  LoopCount count;
  for (int k = 0; k <= static_cast<int>(std::fabs(turned_rad) / kStep_rad); ++k) {
    const double heading = std::copysign(kStep_rad, turned_rad) * k, way_m = kStep_rad * k * radius_m;
    const Vec2 at{radius_m * std::sin(heading), std::copysign(radius_m, turned_rad) * (1.0 - std::cos(heading))};
    count.add(0.1 * k, {at.x, at.y, wrap_angle(heading)}, {9, 9}, 20.0 - nearer * way_m / kMps);
  }
  return count.loops_at_s().size();
}

TEST_CASE("a loop is a full turn within 6 m of way that brought the robot no nearer to its goal") {
  for (const double side : {1.0, -1.0}) {
    CHECK(loops_of(0.5, side * 6.2, 0.0) == 0);
    CHECK(loops_of(0.5, side * 6.4, 0.0) == 1);
    CHECK(loops_of(0.5, side * 12.7, 0.0) == 2);
    CHECK(loops_of(0.0, side * 6.4, 0.0) == 1);  // on the spot
    CHECK(loops_of(0.9, side * 6.4, 0.0) == 1);
    CHECK(loops_of(1.0, side * 20.0, 0.0) == 0);  // 6.3 m round
    CHECK(loops_of(0.5, side * 6.4, 0.5) == 0);
  }
}

TEST_CASE("what turns back is no loop, and a new goal begins anew") {
  LoopCount rocks, has_two_goals;
  for (int k = 0; k < 2000; ++k) rocks.add(0.1 * k, {0, 0, 3.1 * std::sin(0.01 * k)}, {9, 9}, 20.0);
  CHECK(rocks.loops_at_s().empty());
  for (int k = 0; k < 60; ++k) has_two_goals.add(0.1 * k, {0, 0, wrap_angle(0.2 * k)}, {k < 30 ? 9.0 : 8.0, 9}, 20.0);
  CHECK(has_two_goals.loops_at_s().empty());
}

}  // namespace

TEST_CASE("a wait is told with how long it was and the body that was nearest meanwhile") {
  Waits waits;
  waits.add(10.0, 2.9, {1.0, 0.0, 0.0}, "too short");
  CHECK_FALSE(waits.any());
  waits.add(20.0, 5.0, {1.0, 2.0, 0.0}, "something stood in its way");
  waits.note(19.0, 3, {1.0, 2.1}, {0.0, 0.0});  // before
  waits.note(21.0, 4, {1.0, 3.5}, {0.4, 0.0});
  waits.note(24.0, 5, {2.0, 2.0}, {0.0, 0.1});
  CHECK(waits.words() ==
        "Its longest waits:\n  at 20.0 s, 1.0, 2.0 m, for 5.0 s: something stood in its way; body 5 was 1.0 m from its "
        "middle and stood\n");
}

}  // namespace jaywalk
