#include "planner/tracking/steady_walk.h"

#include <array>

#include "tests/perception/walker.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

TEST_CASE("who grows as he goes must go twice as far where nobody called the ground free") {
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  body.arc_m = 0.25;
  const auto walks_growing = [&](double by_m, double free_share) {  // 0.18 m in the 0.9 s from first place to last
    body.path.clear();
    for (int k = 1; k <= 10; ++k)
      body.path.add(time_from_seconds(0.1 * k),
                    {.where_in_map = {3.0, 0.02 * k}, .width_m = 0.4 + by_m / 9.0 * k, .whole = true});
    body.free_share = free_share;
    return steady(body, body.path.fit());
  };
  CHECK(walks_growing(0.08, 0.0));
  CHECK_FALSE(walks_growing(0.1, 0.0));
  CHECK(walks_growing(0.1, 1.0));
}

TEST_CASE("of a body that is seen whole both sides must have gone, but not one that was hidden where it set out") {
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  body.arc_m = 0.25;
  CHECK(steady(body, body.path.fit()));
  const Body both_went = body;
  body.outline_in_map[0] = body.anchor_outline[0];  // its other side came into view, and its middle went that way
  CHECK_FALSE(steady(body, body.path.fit()));
  body.anchor_low_seen = false;  // it was what hid that side that ended there
  CHECK(steady(body, body.path.fit()));
  body = both_went;
  body.outline_in_map.back() = body.anchor_outline.back();
  CHECK_FALSE(steady(body, body.path.fit()));
  body.anchor_high_seen = false;
  CHECK(steady(body, body.path.fit()));
}

TEST_CASE("where a body begins to be watched it is remembered which of its sides are seen") {
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  const auto seen_at_anchor = [&](bool whole, int hidden_side) {
    body.whole = whole;
    body.hidden_side = hidden_side;
    anchor_here(body, {}, time_from_seconds(1.0));
    return std::array{body.anchor_low_seen, body.anchor_high_seen};
  };
  CHECK(seen_at_anchor(true, 0) == std::array{true, true});
  CHECK(seen_at_anchor(false, 1) == std::array{true, false});
  CHECK(seen_at_anchor(false, -1) == std::array{false, true});
  CHECK(seen_at_anchor(false, 0) == std::array{false, false});
}
