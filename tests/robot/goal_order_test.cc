#include "firmware/robot/goal_order.h"

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;

namespace {

const std::vector<NamedPlace> kPlaces{{"kitchen", {{4.0, 1.5}, 1.57}}, {"hall", {{-1.0, 2.0}}}};

std::string complaint_about(const std::string& words) {
  return refusal_of([&] { return read_goal_order(words); });
}

std::string complaint_about_route(const std::string& words) {
  return refusal_of([&] { return read_route(words, kPlaces); });
}

}  // namespace

TEST_CASE("a goal is two numbers, or three with the heading") {
  const GoalOrder place = read_goal_order("4.0 -1.5");
  CHECK(place.position_in_map == Vec2{4.0, -1.5});
  CHECK(std::isnan(place.heading_rad));
  const GoalOrder pose = read_goal_order("  -1   -2 -1.57 ");
  CHECK(pose.position_in_map == Vec2{-1.0, -2.0});
  CHECK(pose.heading_rad == -1.57);
}

TEST_CASE("a heading of up to a turn is the same one between -pi and pi") {
  CHECK(read_goal_order("0 0 4").heading_rad == Approx(4.0 - 2.0 * kPi));  // -2.283
  CHECK(read_goal_order("0 0 -6.283").heading_rad == Approx(2.0 * kPi - 6.283).margin(1e-9));
}

TEST_CASE("names of places make a route in the order to go, one that is not there is refused with what was meant") {
  const Route route = read_route("hall kitchen hall", kPlaces);
  REQUIRE(route.size() == 3);
  CHECK(route[0].position_in_map == Vec2{-1.0, 2.0});
  CHECK(std::isnan(route[0].heading_rad));
  CHECK(route[1].position_in_map == Vec2{4.0, 1.5});
  CHECK(route[1].heading_rad == 1.57);
  CHECK(read_route("3 4", kPlaces)[0].position_in_map == Vec2{3.0, 4.0});
  CHECK(complaint_about_route("hall kitchn") == "goto: there is no place kitchn; did you mean kitchen?");
  CHECK(complaint_about_route("one 1.5") == "goto: X one is no number; give metres in the map, at most 100000");
  CHECK(complaint_about_route("attic") == "goto: there is no place attic; there are kitchen, hall");
  std::string long_way = "hall";
  for (int k = 1; k < 17; ++k) long_way += " hall";
  CHECK(complaint_about_route(long_way) == "goto: 17 places; give at most 16");
  CHECK_THROWS_AS(read_route("hall", {}), StartupError);
}

TEST_CASE("an order's words give the same order, to the last bit") {
  for (const char* words : {"0.1 -1e5", "0.1 0.2 0.30000000000000004", "-1e-300 3 -3.1"}) {
    const GoalOrder order = read_goal_order(words);
    const GoalOrder again = read_goal_order(words_of(order));
    CHECK(again.position_in_map == order.position_in_map);
    CHECK((again.heading_rad == order.heading_rad || std::isnan(order.heading_rad)));
    CHECK(std::isnan(again.heading_rad) == std::isnan(order.heading_rad));
  }
}

TEST_CASE("what is no goal is refused with its place, its cause and what to give") {
  const std::string metres = "; give metres in the map, at most 100000",
                    radians = "; give radians in the map, a turn (6.2832) at most",
                    no_goal = " words make no goal; give X Y, X Y HEADING, or names of places";
  const std::pair<const char*, std::string> refused[] = {{"", "0" + no_goal},
                                                         {"1", "1" + no_goal},
                                                         {"1 2 3 4", "4" + no_goal},
                                                         {"1 2m", "Y 2m is no number" + metres},
                                                         {"nan 2", "X nan is not finite" + metres},
                                                         {"1 -inf", "Y -inf is not finite" + metres},
                                                         {"1e9 2", "X 1e9 is out of range" + metres},
                                                         {"0 0 6.29", "HEADING 6.29 is out of range" + radians},
                                                         {"0 0 -90", "HEADING -90 is out of range" + radians},
                                                         {"0 0 nan", "HEADING nan is not finite" + radians},
                                                         {"0 0 east", "HEADING east is no number" + radians}};
  for (const auto& [words, complaint] : refused) CHECK(complaint_about(words) == "goto: " + complaint);
  CHECK_FALSE(complaint_about("1e999 2").empty());
  CHECK_FALSE(complaint_about(std::string("1 2\0", 4)).empty());
}
