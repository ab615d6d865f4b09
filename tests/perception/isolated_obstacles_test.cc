#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr Pose2 kAhead{}, kBack{0.0, 0.0, kPi};  // three quarters of a turn are looked at

/// Any cell within 0.4 m of a place.
bool remembers(const Watch& watch, Vec2 place) {
  const EvidenceMap& still = watch.tracker.still();
  const CellIndex middle = still.cell_at(place);
  return occupied_cells(still, {middle.i - 4, middle.j - 4}, {middle.i + 5, middle.j + 5}) > 0;
}

/// Looks at the room for a second ahead, then for two the other way.
void look_and_turn(Watch& watch, const Room& room) {
  for (int k = 0; k < 15; ++k) watch.see(room, kAhead);
  for (int k = 0; k < 30; ++k) watch.see(room, kBack);
}

}  // namespace

TEST_CASE("what stands alone out of sight is forgotten, what is in view and walls are not") {
  constexpr Vec2 kUnseen{3.0, 0.5}, kSeen{-3.0, 0.5};
  Watch watch;
  look_and_turn(watch, with({{kUnseen, 0.3}, {kSeen, 0.3}}));
  REQUIRE((remembers(watch, kUnseen) && remembers(watch, kSeen)));
  watch.tracker.forget_unseen();
  CHECK_FALSE(remembers(watch, kUnseen));
  CHECK(remembers(watch, kSeen));
  CHECK((remembers(watch, {6.0, 0.0}) && remembers(watch, {-6.0, 0.0})));
}

TEST_CASE("what is wider than bodies are, or stands at a wall, is not forgotten") {
  const auto [from, to] = GENERATE(table<Vec2, Vec2>({{{3.0, -0.9}, {3.0, 0.9}}, {{5.0, 0.5}, {6.0, 0.5}}}));
  Watch watch;
  look_and_turn(watch, with({}, {{from, to}}));
  const Vec2 middle = (from + to) * 0.5;
  REQUIRE(remembers(watch, middle));
  watch.tracker.forget_unseen();
  CHECK(remembers(watch, middle));
}

TEST_CASE("a thing of which a part is in view stays whole") {
  Watch watch;
  const Room room = with({}, {{{-1.5, 2.4}, {-1.5, 3.4}}});  // across the edge of what is looked at ahead
  for (int k = 0; k < 15; ++k) watch.see(room, kBack);
  for (int k = 0; k < 15; ++k) watch.see(room, kAhead);
  const bool both = remembers(watch, {-1.5, 2.4}) && remembers(watch, {-1.5, 3.4});
  REQUIRE(both);
  watch.tracker.forget_unseen();
  CHECK((remembers(watch, {-1.5, 2.4}) && remembers(watch, {-1.5, 3.4})));
}
