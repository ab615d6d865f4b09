// Cell functions against numbers worked by hand, and against double precision.
#include "planner/cell/cell.h"

#include <cmath>

#include "planner/cell/kalman.h"
#include "planner/paper/mark_stages.h"
#include "planner/paper/path.h"
#include "planner/paper/potential_stages.h"
#include "planner/paper/start_field.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("exp in single precision stays within 4e-7 of the truth from -80 to 80") {
  double worst = 0.0;
  for (int k = -80000; k <= 80000; ++k) {
    const float x = static_cast<float>(k) * 1e-3F;
    const double truth = std::exp(static_cast<double>(x));
    worst = std::max(worst, std::fabs(static_cast<double>(cell::exp(x)) - truth) / truth);
  }
  CHECK(worst < 4e-7);
  CHECK(cell::exp(0.0F) == 1.0F);
  CHECK(cell::exp(-1e9F) == cell::exp(-80.0F));
}

TEST_CASE("log in single precision stays within 2e-7 of the truth, near 1 too") {
  double worst_near = 0.0, worst_far = 0.0;
  for (int k = 1; k <= 200000; ++k) {
    const float x = static_cast<float>(k) * 1e-5F;  // up to 2
    const double truth = std::log(static_cast<double>(x));
    if (truth != 0.0) worst_near = std::max(worst_near, std::fabs(static_cast<double>(cell::log(x)) / truth - 1.0));
    const float big = x * 1e20F;
    worst_far =
        std::max(worst_far, std::fabs(static_cast<double>(cell::log(big)) / std::log(static_cast<double>(big)) - 1.0));
  }
  CHECK(worst_near < 3e-7);
  CHECK(worst_far < 3e-7);
  CHECK(cell::log(1.0F) == 0.0F);
}

TEST_CASE("warp radius: straight ahead a/1.9, straight behind ten times the distance, abeam 9.18 times") {
  // 0.19 r^2 + 1.8 a r - (a^2 + 16 l^2) = 0. Ahead, a = 3.8, l = 0: r = (3.8 - 3.42)/0.19 = 2.
  CHECK(paper::warp_radius(3.8F, 0.0F) == Approx(2.0F));
  // Behind, a = -2: r = (2 + 1.8)/0.19 = 20.
  CHECK(paper::warp_radius(-2.0F, 0.0F) == Approx(20.0F));
  // Abeam, l = 1: r = sqrt(3.04)/0.19 = 9.1766, on either side.
  CHECK(paper::warp_radius(0.0F, 1.0F) == Approx(9.1766F).epsilon(1e-4));
  CHECK(paper::warp_radius(0.0F, -1.0F) == paper::warp_radius(0.0F, 1.0F));
}

TEST_CASE("a place on the ellipse satisfies the paper's implicit equation") {
  const float a = 1.3F, l = -0.7F;
  const float r = paper::warp_radius(a, l);
  const float from_centre = a - 0.9F * r;
  CHECK(std::sqrt(from_centre * from_centre + 16.0F * l * l) == Approx(r).epsilon(1e-4));
}

TEST_CASE("head-on, overtaking, crossing, standing and from behind: who is where at the horizon") {
  const float cap = 5.0F;
  // Head-on at 3.8 m, both at 0.5 m/s: r = 2 m, 4 s; the mover is then 1.8 m ahead, near the middle.
  CHECK(paper::horizon(paper::warp_radius(3.8F, 0.0F), 0.5F, cap) == Approx(4.0F));
  // Overtaking one at 0.25 m/s that is 1.9 m ahead: r = 1 m, displaced by 1 m: 4 s.
  CHECK(paper::horizon(paper::warp_radius(1.9F, 0.0F), 0.25F, cap) == Approx(4.0F));
  // Crossing from 2 m abeam at 0.5 m/s: 18.4 m, that is 37 s: the cap.
  CHECK(paper::horizon(paper::warp_radius(0.0F, 2.0F), 0.5F, cap) == cap);
  // Standing: never covers any radius: the cap, where it still stands.
  CHECK(paper::horizon(paper::warp_radius(1.9F, 0.0F), 0.0F, cap) == cap);
  // From behind, 0.2 m away: r = 2 m.
  CHECK(paper::horizon(paper::warp_radius(-0.2F, 0.0F), 0.5F, cap) == Approx(4.0F));
}

TEST_CASE("Kalman prediction over 2 s by hand: position, covariance and process noise, the same in two steps of 1 s") {
  // p = 1 + 2*3 = 7. pp = 0.1 + 2*2*0.02 + 4*0.05 + 0.3*8/3 = 0.1 + 0.08 + 0.2 + 0.8 = 1.18.
  // pv = 0.02 + 2*0.05 + 0.3*4/2 = 0.72. vv = 0.05 + 0.3*2 = 0.65.
  const cell::AxisState from{1.0F, 3.0F, 0.1F, 0.02F, 0.05F}, s = cell::predict(from, 2.0F, 0.3F);
  CHECK(s.position == Approx(7.0F));
  CHECK(s.velocity == 3.0F);
  CHECK(s.pp == Approx(1.18F));
  CHECK(s.pv == Approx(0.72F));
  CHECK(s.vv == Approx(0.65F));
  const cell::AxisState twice = cell::predict(cell::predict(from, 1.0F, 0.3F), 1.0F, 0.3F);
  CHECK(twice.pp == Approx(s.pp));
  CHECK(twice.pv == Approx(s.pv));
}

TEST_CASE("a mark is body, safety distance and one standard deviation, no more than the widest") {
  // 0.3 + 0.2 + sqrt(0.04) = 0.7; with sqrt(1) = 1 capped at 0.4: 0.9.
  CHECK(paper::mark_radius(0.3F, 0.2F, 0.04F, 0.4F) == Approx(0.7F));
  CHECK(paper::mark_radius(0.3F, 0.2F, 1.0F, 0.4F) == Approx(0.9F));
}

TEST_CASE("coupling is a quarter between equals, nothing from what is not free") {
  CHECK(paper::coupling(3.0F, 3.0F, true) == 0.25F);
  CHECK(paper::coupling(3.0F, 3.0F + 0.69314718F, true) == Approx(0.125F));  // u halves
  CHECK(paper::coupling(3.0F, 3.0F, false) == 0.0F);
  CHECK(paper::coupling(3.0F, cell::kNotFree, true) == 0.0F);
  CHECK(paper::coupling(cell::kNotFree, 3.0F, true) == 0.0F);
  CHECK(paper::coupling(3.0F, cell::kUnreachable, true) == 0.0F);
  CHECK(paper::coupling_back(0.125F) == 0.5F);  // u doubles
  CHECK(paper::coupling_back(0.0F) == 0.0F);
  CHECK(paper::rebased(2.0F, 0.5F) == Approx(2.693147F));
}

TEST_CASE("a block weighs its cells by u squared, and not those without an equation") {
  // exp(-2 ln 2) = 1/4.
  CHECK(paper::block_weight(true, 1.5F, 3.0F + 0.69314718F, 3.0F) == Approx(0.375F));
  CHECK(paper::block_weight(false, 1.5F, cell::kNotFree, 3.0F) == 0.0F);
}

TEST_CASE("a correction never takes v below an eighth of what it was, and leaves cells without an equation at 0") {
  CHECK(paper::corrected(1.0F, 0.5F) == 1.5F);
  CHECK(paper::corrected(1.0F, -0.9F) == 0.125F);
  CHECK(paper::corrected(0.0F, 0.5F) == 0.0F);
}

TEST_CASE("a passage one, two and four cells wide decays by acosh of 2, 1.5 and 1.19 a cell") {
  // acosh(2 - cos(pi/2)) = 1.31696, acosh(2 - cos(pi/3)) = 0.96242, acosh(2 - cos(pi/5)) = 0.60860; half of it in
  // 1/4096.
  const auto table = paper::rate_table(64);
  CHECK(table[4] == 2697);
  CHECK(table[8] == 1971);
  CHECK(table[16] == 1246);
}

TEST_CASE("the band's tension points to the neighbours' middle, its force away from what is near") {
  const paper::Point t = paper::tension({0.0F, 0.0F}, {1.0F, 1.0F}, {2.0F, 0.0F});
  CHECK(t.x == 0.0F);
  CHECK(t.y == -1.0F);
  // Clearance 2 of 5: strength (1 - 0.4)/2 = 0.3 along the slope; beyond 5 nothing.
  const paper::Point f = paper::clearance_force(2.0F, {0.0F, 1.0F}, 5.0F);
  CHECK(f.y == Approx(0.3F));
  CHECK(paper::clearance_force(6.0F, {0.0F, 1.0F}, 5.0F).y == 0.0F);
}

TEST_CASE("a passage is as wide as its cells' clearances say, from its middle line and from beside it") {
  // Seven cells 1 2 3 4 3 2 1 and six 1 2 3 3 2 1, along x; those along y are as far from walls as the cell itself.
  CHECK(paper::passage_width(4.0F, 3.0F, 4.0F) == 7.0F);
  CHECK(paper::passage_width(3.0F, 3.0F, 3.0F) == 6.0F);
  CHECK(paper::passage_width(3.0F, 4.0F, 3.0F) == 7.0F);
  CHECK(paper::passage_width(1.0F, 0.0F, 1.0F) == 1.0F);  // one cell wide
}

TEST_CASE(
    "a diagonal step costs a quarter more than a straight one, and never less than a way round the corner allows") {
  CHECK(paper::straight_step(100, 60) == 160);
  CHECK(paper::diagonal_step(100, 60, 70, 90) == 201);          // 160 + 40 + 160^2/16384
  CHECK(paper::diagonal_step(1971, 1971, 1971, 1971) == 5875);  // two cells wide: 3942 + 985 + 948
  CHECK(paper::diagonal_step(10, 20, 400, 300) == 321);  // 300 + 20 + 1: the corner, 320 from `to` at most, stays lower
}
