#include "hal/sim/movers.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

const std::string kHead = "t_s,id,x_m,y_m\n";
// Seven walks along x from t 10 to 14 with a stop; nine is there from 12 to 13.
const std::string kTwo = kHead + "10,7,0,0\n12,7,2,0\n13,7,2,0\n14,7,2,1\n12,9,5,5\n13,9,5,6\n";
const RobotBody kFarAway{p3dx().footprint, {100.0, 100.0, 0.0}};

RecordedMovers recorded(const RecordedSpec& spec) { return RecordedMovers({&spec, 1}, 4); }

RecordedSpec two() { return {.file = folder().write("two.csv", kTwo), .radius_m = 0.25}; }

}  // namespace

TEST_CASE("people walk straight between their places and come and go") {
  RecordedMovers people = recorded(two());
  CHECK(people.capacity() == 2);
  people.place(0.5, kFarAway);
  REQUIRE(people.movers().size() == 1);
  CHECK(people.movers()[0].id == 5);  // the first after 4
  CHECK(people.movers()[0].position == Vec2{0.5, 0.0});
  CHECK(people.movers()[0].velocity == Vec2{1.0, 0.0});
  people.place(2.5, kFarAway);
  REQUIRE(people.movers().size() == 2);
  CHECK(people.movers()[0].velocity == Vec2{});
  CHECK(people.movers()[0].heading == 0.0);  // looks where it last walked
  CHECK(people.movers()[1].position == Vec2{5.0, 5.5});
  people.place(3.5, kFarAway);
  REQUIRE(people.movers().size() == 1);
  CHECK(people.movers()[0].position == Vec2{2.0, 0.5});
  CHECK(people.movers()[0].heading == Approx(kPi / 2));
  people.place(4.0, kFarAway);
  CHECK(people.movers().empty());
}

TEST_CASE("offset moves them, start_at_s makes them late") {
  RecordedSpec spec = two();
  spec.offset = {10.0, 20.0};
  spec.start_at_s = 3.0;
  RecordedMovers people = recorded(spec);
  people.place(2.9, kFarAway);
  CHECK(people.movers().empty());
  people.place(4.0, kFarAway);
  REQUIRE(people.movers().size() == 1);
  CHECK(people.movers()[0].position == Vec2{11.0, 20.0});
}

TEST_CASE("a looped recording begins anew after its 4 s") {
  RecordedSpec spec = two();
  spec.loop = true;
  RecordedMovers people = recorded(spec);
  people.place(3.5, kFarAway);
  people.place(8.5, kFarAway);
  REQUIRE(people.movers().size() == 1);
  CHECK(people.movers()[0].position.x == Approx(0.5));
}

TEST_CASE("a person is forced once when the robot comes within 0.4 m ahead, not beside") {
  RecordedMovers people = recorded(two());  // walks along x, its edge 0.25 m ahead of its middle
  const auto robot_at = [](double x, double y) { return RobotBody{p3dx().footprint, {x, y, 0.0}}; };
  people.place(0.1, robot_at(0.1 + 0.25 + 0.41 + 0.301, 0.0));
  CHECK(people.forced() == 0);
  people.place(0.1, robot_at(0.1, 0.6));
  CHECK(people.forced() == 0);
  people.place(0.1, robot_at(0.1 + 0.25 + 0.39 + 0.301, 0.0));
  CHECK(people.forced() == 1);
  CHECK(people.movers()[0].forced);
  people.place(0.12, robot_at(0.1 + 0.25 + 0.39 + 0.301, 0.0));
  CHECK(people.forced() == 1);
  people.place(0.14, kFarAway);
  CHECK_FALSE(people.movers()[0].forced);
  people.place(0.16, robot_at(0.9, 0.0));
  CHECK(people.forced() == 2);
}

TEST_CASE("bad recordings of movers are refused with file, line and cause") {
  const std::vector<Bad> cases{{"", "walk.csv: holds nobody"},
                               {kHead, "walk.csv:1: holds nobody"},
                               {"0,1,2,3\n", "walk.csv:1: does not begin with t_s,id,x_m,y_m"},
                               {kHead + "0,1,2\n", "walk.csv:2: "},
                               {kHead + "0,1,2,3\n0,1,2,3,4\n", "walk.csv:3: "},
                               {kHead + "0,1,2,nan\n", "walk.csv:2: "},
                               {kHead + "0,1.5,2,3\n", "walk.csv:2: "},
                               {kHead + "0,1,2,1e99\n", "walk.csv:2: "}};
  check_refused(cases, [](const std::string& text) {
    const RecordedSpec spec{.file = folder().write("walk.csv", text), .radius_m = 0.25};
    return refusal_of([&spec] { return recorded(spec); });
  });
}
