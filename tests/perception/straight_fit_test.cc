#include "planner/tracking/straight_fit.h"

#include "tests/perception/walker.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

TEST_CASE("a straight walk explains its places fully") {
  const StraightFit walk = history(0, 9, [](int k) { return Sample{{0.04 * k, 0.03 * k}}; }).fit();
  CHECK(walk.positions == 10);
  CHECK(walk.duration_s == Approx(0.9));
  CHECK(walk.length_m == Approx(0.45));  // 9 steps of 5 cm
  CHECK(walk.explained == Approx(1.0));
}

TEST_CASE("of one hop in the middle a straight walk explains three quarters") {
  const StraightFit hop = history(0, 9, [](int k) { return Sample{{k < 5 ? 0.0 : 0.4, 0.0}}; }).fit();
  // x = -0.2 five times then +0.2; t = -4.5 .. 4.5. Sum t x = 2 x 0.2 x (0.5 + 1.5 + 2.5 + 3.5 + 4.5) = 5.0;
  // sum t^2 = 82.5; sum x^2 = 0.4; explained = 5.0^2 / (82.5 x 0.4) = 0.7576.
  CHECK(hop.explained == Approx(0.7576).margin(1e-4));
}

TEST_CASE("only the last one and a half seconds count") {
  const auto path = history(0, 20, [](int k) { return Sample{{k < 5 ? 5.0 * (k % 2) : 0.1 * k, 0.0}}; });
  CHECK(path.fit().positions == 16);  // from 0.5 s to 2.0 s
  CHECK(path.fit().explained == Approx(1.0));
  CHECK(path.fit().length_m == Approx(1.5));
}

TEST_CASE("places nearer in time than a fast laser tells apart are one") {
  const auto at = [](int k) { return Sample{{0.01 * k, 0.0}}; };
  const auto path = history(0, 79, at, 0.025);  // 40 Hz, 0.4 m/s
  // Three scans a place, 75 ms apart, and the last one (79 = 3 x 26 + 1) has two. Of those within 1.5 s of the newest,
  // at 1.9625 s, the oldest is at 0.475 s: 20 steps later, 0.0125 s short of 1.5 s. 0.4 m/s for 1.4875 s is 0.595 m.
  CHECK(path.fit().positions == 21);
  CHECK(path.fit().duration_s == Approx(1.4875));
  CHECK(path.fit().length_m == Approx(0.595).margin(0.001));
}

TEST_CASE("a hop is what a walker could not have walked") {
  const auto path = history(0, 9, [](int k) { return Sample{{0.05 * k + (k < 5 ? 0.0 : 0.4), 0.0}}; });
  CHECK(path.fit().longest_hop_m == Approx(0.3));  // 0.45 m in 0.1 s, of which a walker walks 0.15 m
}

TEST_CASE("standing exactly still is no walk") {
  const auto path = history(0, 9, [](int) { return Sample{{1.0, 1.0}}; });
  CHECK(path.fit().explained == 0.0);
  CHECK(path.fit().length_m == 0.0);
}

TEST_CASE("a walk is as many standard deviations long as its places scatter about it") {
  // x = 0.04 k and 1 cm to and fro beside it, k = 0 .. 9, 0.1 s apart: tt = 0.825 s^2. y = +-0.01 in turns has
  // slope sum(t y) / tt = 0.01 x (-0.5) / 0.825 and leaves 0.001 - (0.005)^2 / 0.825 = 0.00096970 m^2. The noise:
  // (0.00096970 + 4 x 0.0001) / (20 - 4 + 4) = 6.8485e-5 m^2; speed sqrt(0.4^2 + 0.00606^2) = 0.40005 m/s.
  const auto path = history(0, 9, [](int k) { return Sample{{0.04 * k, k % 2 == 0 ? 0.01 : -0.01}}; });
  CHECK(path.fit().sigmas == Approx(0.40005 * 0.9083 / 0.0082756).epsilon(1e-3));
  CHECK(path.fit_newest(5).positions == 10);  // it walked all the time
  CHECK(path.fit_newest(5).sigmas == path.fit().sigmas);
}

TEST_CASE("width changes by the widest less the narrowest of those seen whole") {
  const double widths[] = {0.5, 0.2, 0.42, 0.61, 0.7};
  const bool whole[] = {true, false, true, true, false};
  const auto path = history(0, 4, [&](int k) { return Sample{{0.1 * k, 0.0}, widths[k], 0.0, whole[k]}; });
  CHECK(path.fit().width_change_m == Approx(0.19));
  CHECK(path.fit().whole_positions == 3);
}

TEST_CASE("who stood until just now has walked only since") {
  const auto at = [](int k) {  // a millimetre to and fro, then 3 cm a scan
    const double gone_m = k < 12 ? 0.0 : 0.03 * (k - 11);
    return Sample{.where_in_map = {gone_m, k % 2 == 0 ? 0.001 : 0.0}, .spacing_m = 0.01 * k};
  };
  const auto path = history(0, 19, at, 1.0 / 15.0);
  const StraightFit all = path.fit(), since = path.fit_newest(5);
  CHECK(all.positions == 20);
  CHECK(all.explained < 0.8);
  CHECK(since.positions >= 8);  // a place or two of standing cost little
  CHECK(since.positions <= 10);
  CHECK(since.explained > 0.98);
  CHECK(since.length_m == Approx(0.24).margin(0.03));
  CHECK(since.sigmas > 1.5 * all.sigmas);
  CHECK(since.spacing_m == Approx(0.19));
  CHECK(PositionHistory().fit_newest(0).positions == 0);
  CHECK(path.fit_newest(20).positions == 20);
  CHECK(path.fit_newest(21).positions == 0);
}

TEST_CASE("who grows as he goes must go twice as far") {
  Target target = walker({3.0, 0.0}, {3.0, 0.2});
  target.appearance.arc_m = 0.25;
  const auto walks_growing = [&](double by_m) {  // 0.18 m in the 0.9 s from first place to last
    target.onset.positions = history(1, 10, [&](int k) {
      return Sample{{3.0, 0.02 * k}, 0.4 + by_m / 9.0 * k, 0.0, true};
    });
    return steady(target, target.onset.positions.fit());
  };
  CHECK(walks_growing(0.08));
  CHECK_FALSE(walks_growing(0.1));
}
