#include "planner/localization/scan_matcher.h"

#include <memory>

#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// The map after two seconds of standing in `room`.
std::unique_ptr<Tracker> known(const Room& room) {
  auto tracker =
      std::make_unique<Tracker>(PerceptionConfig{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}});
  for (std::uint32_t k = 1; k <= 30; ++k) tracker->update(scan_of(room, {}, k), {});
  return tracker;
}

MatchResult match(const Tracker& tracker, const Room& seen) {
  const auto matcher = std::make_unique<ScanMatcher>();
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan_of(seen, {}, 40), {}, {}, *points);
  return matcher->match(*points, {tracker.still()}, {{}, diagonal(1e-4, 1e-4, 1e-5)});
}

}  // namespace

TEST_CASE("a scan of what the map holds is matched, one of other walls is contradicted") {
  const auto tracker = known(rectangle(8.0, 6.0));
  const MatchResult same = match(*tracker, rectangle(8.0, 6.0));
  CHECK(same.matched);
  CHECK_FALSE(same.contradicted);
  CHECK(same.fit > 0.9);
  const MatchResult other = match(*tracker, rectangle(4.0, 3.0));  // where the map knows free space
  CHECK_FALSE(other.matched);
  CHECK(other.contradicted);
}

TEST_CASE("a scan of which the map knows next to nothing is neither matched nor contradicted") {
  const auto tracker = known(rectangle(8.0, 6.0));
  Room beyond;  // the walls are gone, and farther off stand others
  beyond.walls = rectangle(14.0, 12.0).walls;
  beyond.discs = {{{2.0, 0.0}, 0.3}};  // in the open, a few beams wide
  const MatchResult result = match(*tracker, beyond);
  CHECK(result.points_used > 200);
  CHECK_FALSE(result.matched);
  CHECK_FALSE(result.contradicted);
}

TEST_CASE("a piece of wall that fifteen beams meet is enough to be matched, one that ten meet is not") {
  const auto tracker = known(rectangle(8.0, 6.0));
  const auto piece = [](double width_m) {
    return Room{.walls = {{{4.0, -0.5 * width_m}, {4.0, 0.5 * width_m}}}, .discs = {}};
  };
  const MatchResult enough = match(*tracker, piece(0.45));
  CHECK(enough.points_used < 22);
  CHECK(enough.matched);
  CHECK_FALSE(match(*tracker, piece(0.25)).matched);
}
