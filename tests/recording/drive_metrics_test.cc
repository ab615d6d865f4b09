#include "apps/report/drive_metrics.h"

#include <cmath>
#include <limits>

#include "apps/report/csv_file.h"
#include "apps/report/picture/scene.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

std::vector<Vec2> straight_way() {
  std::vector<Vec2> way;
  for (int i = 0; i <= 66; ++i) way.push_back({0.03 * i, 1.0});
  way.insert(way.end(), {{2.0, 1.0}, {2.01, 1.0}});
  return way;
}

std::vector<Vec2> unit_circle() {
  std::vector<Vec2> way;
  for (int i = 0; i <= 6283; ++i) way.push_back(direction(0.001 * i));
  return way;
}

TEST_CASE("a path has its length, and its turns from mark to mark in bins of 10 degrees") {
  struct Row {
    const char* name;
    std::vector<Vec2> way;
    Approx length_m, max_turn_deg;
    std::vector<std::pair<std::size_t, std::uint32_t>> bins;
  };
  const Row rows[] = {
      // Marks at 0.25 .. 2.0 (the last may miss by rounding) have turns at all but the first.
      {"straight on", straight_way(), Approx(2.01), Approx(0.0).margin(1e-9), {{0, 7}}},
      // Marks at 0.25, 0.5, 0.75, 1.0 m of travel: turns of 0, 90 and 0 degrees.
      {"a right angle at a mark", {{0, 0}, {0.5, 0}, {0.5, 0.5}}, Approx(1.0), Approx(90.0), {{0, 2}, {9, 1}}},
      // 0.25 m of travel on a circle of 1 m are 0.25 rad = 14.32 degrees; 25 marks, the first without a turn.
      {"a circle", unit_circle(), Approx(6.283).epsilon(1e-4), Approx(14.32).epsilon(0.01), {{1, 24}}},
      {"back", {{0, 0}, {0.5, 0}, {0, 0}}, Approx(1.0), Approx(180.0), {{kTurnBins - 1, 1}}},
      {"at rest", std::vector<Vec2>(10, Vec2{1, 1}), Approx(0.0), Approx(0.0), {}}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    PathShape shape;
    for (const Vec2 at : row.way) shape.add(at);
    CHECK(shape.length_m() == row.length_m);
    CHECK(shape.max_turn_deg() == row.max_turn_deg);
    for (const auto& [bin, turns] : row.bins) CHECK(shape.turn_histogram()[bin] == turns);
  }
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

TEST_CASE("braking counts as much as speeding up, and before a window is full nothing is told") {
  Smoothness smoothness;
  for (int i = 0; i <= 50; ++i) {
    smoothness.add(Time{Duration{20'000'000LL * i}}, 1.0 - 0.02 * i);
    if (i == 1) CHECK(std::isnan(smoothness.accel_max_mps2()));
  }
  CHECK(smoothness.accel_max_mps2() == Approx(1.0));
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

/// Loops of a drive at a steady turn of 0.4 rad/s: `turned_deg` in all on circles of this radius, a stand of `stands_s`
/// in the middle.
std::vector<Episode> loops_of(double radius_m, double turned_deg, double stands_s = 0.0) {
  constexpr double kStep_deg = 0.5, kRadps = 0.4;
  LoopCount count;
  const int steps = static_cast<int>(std::fabs(turned_deg) / kStep_deg);
  for (int k = 0; k <= steps; ++k) {
    const double turned = kStep_deg / 180.0 * kPi * k, heading = std::copysign(turned, turned_deg);
    const Vec2 at{radius_m * std::sin(heading), std::copysign(radius_m, turned_deg) * (1.0 - std::cos(heading))};
    const double stood_s = 2 * k > steps ? stands_s : 0.0;
    count.add(turned / kRadps + stood_s, {at.x, at.y, wrap_angle(heading)}, {9, 9});
  }
  return count.loops();
}

TEST_CASE("a loop is a net turn by 340 degrees within 10 m of way, whatever the plan said") {
  for (const double side : {1.0, -1.0}) {
    CHECK(loops_of(0.5, side * 339.0).empty());
    CHECK(loops_of(0.5, side * 341.0).size() == 1);
    CHECK(loops_of(0.5, side * 679.0).size() == 1);
    CHECK(loops_of(0.5, side * 685.0).size() == 2);
    CHECK(loops_of(0.0, side * 341.0).size() == 1);        // on the spot
    CHECK(loops_of(1.5, side * 341.0, 90.0).size() == 1);  // 8.9 m: a stand amid it changes nothing
    CHECK(loops_of(2.5, side * 1000.0).empty());           // 14.9 m a turn: the way itself may turn so
  }
  const std::vector<Episode> one = loops_of(0.5, 345.0);
  REQUIRE(one.size() == 1);
  CHECK(one[0].from_s == Approx(0.0).margin(0.3));
  CHECK(one[0].to_s == Approx(340.0 / 180.0 * kPi / 0.4).margin(0.3));
}

TEST_CASE("what turns back is no loop, and a new goal begins anew") {
  LoopCount rocks, has_two_goals;
  for (int k = 0; k < 2000; ++k) rocks.add(0.1 * k, {0, 0, 2.9 * std::sin(0.01 * k)}, {9, 9});
  CHECK(rocks.loops().empty());
  for (int k = 0; k < 60; ++k) has_two_goals.add(0.1 * k, {0, 0, wrap_angle(0.19 * k)}, {k < 30 ? 9.0 : 8.0, 9});
  CHECK(has_two_goals.loops().empty());
}

TEST_CASE("a detour is way above 1.5 times the fall of the way to go") {
  DetourCount count;
  // 3 m nearer by as much; 6 m that bring it 3 m nearer: 6 - 1.5 * 3 = 1.5 m over, in two halves; 3 m nearer.
  for (int k = 0; k <= 1200; ++k) {
    const double way_m = 0.01 * k, slow_m = std::clamp(way_m - 3.0, 0.0, 6.0);
    count.add(0.1 * k, {way_m, 0}, {99, 0}, 20.0 - way_m + 0.5 * slow_m);
  }
  CHECK(count.detour_m() == Approx(1.5).margin(0.05));
  REQUIRE(count.detours().size() == 1);
  CHECK(count.detours()[0].from_s == Approx(30.0).margin(0.3));
  CHECK(count.detours()[0].to_s == Approx(90.0).margin(0.3));
}

TEST_CASE(
    "a way that proves longer where the robot stands is no detour, and to go away counts as no more than its way") {
  DetourCount waits, leaves;
  for (int k = 0; k < 100; ++k) waits.add(0.1 * k, {0, 0}, {99, 0}, k < 50 ? 10.0 : 30.0);
  CHECK(waits.detour_m() == 0.0);
  for (int k = 0; k <= 310; ++k) leaves.add(0.1 * k, {0.01 * k, 0}, {99, 0}, 10.0 + 0.05 * k);
  CHECK(leaves.detour_m() == Approx(3.0).margin(0.02));
}

}  // namespace

}  // namespace jaywalk
