#include "planner/perception/bodies.h"

#include <memory>

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("when the list is full the farthest from the robot goes") {
  const auto bodies = std::make_unique<Bodies>();
  for (std::uint32_t k = 1; k <= kMaxTracks; ++k) {
    admit(*bodies, born_at({static_cast<double>(k), 0.0}, 0.1, 0.25, time_from_seconds(0.0), k), {0.0, 0.0});
  }
  REQUIRE(bodies->full());
  const auto has = [&](std::uint32_t id) {
    for (const Body& body : *bodies) {
      if (body.track.id == id) return true;
    }
    return false;
  };

  admit(*bodies, born_at({2.5, 0.0}, 0.1, 0.25, time_from_seconds(1.0), 100), {0.0, 0.0});
  CHECK(has(100));
  CHECK_FALSE(has(64));  // it stood 64 m away

  admit(*bodies, born_at({200.0, 0.0}, 0.1, 0.25, time_from_seconds(2.0), 101), {0.0, 0.0});
  CHECK_FALSE(has(101));  // the newcomer was the farthest itself
  CHECK(has(63));
  CHECK(bodies->size() == kMaxTracks);
}
