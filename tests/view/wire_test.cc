// What live page, Foxglove and program say to each other.
#include <cmath>
#include <string>
#include <vector>

#include "apps/view/foxglove_session.h"
#include "apps/view/live_view.h"
#include "apps/view/view_orders.h"
#include "apps/view/view_scene.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::view;

TEST_CASE("orders are a goal with or without a heading, stop, reset, pause or step") {
  const auto goal = parse_order(R"({"goal":[1.5,-2,0.5]})");
  REQUIRE(goal);
  CHECK(goal->goal->position_in_map == Vec2{1.5, -2.0});
  CHECK(goal->goal->heading_rad == 0.5);
  CHECK(std::isnan(parse_order(R"({"goal":[1,2]})")->goal->heading_rad));
  CHECK(parse_order(R"({"here":[1,2,0.5]})")->here->heading_rad == 0.5);
  CHECK(parse_order(R"({"stop":true})")->stop);
  CHECK(parse_order(R"({"reset":true})")->reset);
  CHECK(parse_order(R"({"pause":false})")->pause == false);
  CHECK(parse_order(R"({"step":true})")->step);
  CHECK(parse_order(R"({"fault":7})")->fault == 7);
  CHECK(parse_order(R"({"walkers":-1})")->walkers == -1);
  CHECK(parse_order(R"({"pace":0.25})")->pace == 0.25);
  for (const char* const text : {R"({"fault":-1})", R"({"walkers":1000})", R"({"pace":0})", R"({"pace":1e9})"})
    CHECK_FALSE(parse_order(text));
}

TEST_CASE("what is no order is left out") {
  for (const char* text :
       {"", "{", "[]", "{}", R"({"goal":[1]})", R"({"goal":[1e300,0]})", R"({"goal":[0,0,180]})", R"({"goal":["a",1]})",
        R"({"goal":1})", R"({"stop":1})", R"({"stop":false})", R"({"jump":true})", R"({"stop":true,"goal":[1,2]})"}) {
    INFO(text);
    CHECK_FALSE(parse_order(text));
  }
}

TEST_CASE("a stop takes back a goal and a reset that wait, and none that follows takes it back", "[stop]") {
  ViewOrders orders;
  orders.add(*parse_order(R"({"goal":[1,2]})"));
  orders.add(*parse_order(R"({"stop":true})"));
  ViewOrder stopped = orders.take();
  CHECK(stopped.stop);
  CHECK_FALSE(stopped.goal);
  CHECK_FALSE(orders.take().stop);
  orders.add(*parse_order(R"({"stop":true})"));
  orders.add(*parse_order(R"({"goal":[1,2]})"));
  CHECK(orders.take().stop);
  orders.add(*parse_order(R"({"reset":true})"));
  orders.add(*parse_order(R"({"stop":true})"));
  stopped = orders.take();
  CHECK(stopped.stop);
  CHECK_FALSE(stopped.reset);
}

TEST_CASE("the page's stop stays pressed until its reset, at rest, no goal counts before", "[stop]") {
  struct GoesToOne final : OperatorPanel {
    [[nodiscard]] OperatorInput latest() noexcept override {
      OperatorInput input;
      input.has_goal = true;
      return input;
    }
  } inner;
  SteeredPanel panel(inner);
  const ViewOrder stop = *parse_order(R"({"stop":true})"), reset = *parse_order(R"({"reset":true})");
  const ViewOrder goal = *parse_order(R"({"goal":[1,2]})");
  CHECK(panel.latest().has_goal);
  panel.obey(stop, false);
  for (const bool at_rest : {false, true}) {
    panel.obey(goal, at_rest);
    CHECK_FALSE(panel.latest().has_goal);
    CHECK(panel.latest().emergency_stop);
  }
  panel.obey(reset, false);
  CHECK(panel.latest().emergency_stop);
  panel.obey(reset, true);
  const OperatorInput input = panel.latest();
  CHECK(input.reset);
  CHECK_FALSE(input.emergency_stop);
  CHECK_FALSE(input.has_goal);  // its own goal is gone
  CHECK_FALSE(panel.latest().reset);
  panel.obey(goal, true);
  CHECK(panel.latest().goal_in_map == Vec2{1.0, 2.0});
  panel.obey(reset, false);
  CHECK_FALSE(panel.latest().reset);
  panel.obey(reset, true);
  CHECK(panel.latest().reset);  // of a fault that the page did not cause
  CHECK_FALSE(panel.latest().reset);
}

TEST_CASE(
    "the field's bytes are its potential in 126 steps, 127 more where nothing was seen, with codes for no way and not "
    "free") {
  const float nan = std::nanf(""), inf = HUGE_VALF;
  const float psi[] = {0.0F, 1.0F, nan, inf, 0.0F, 1.0F};  // the farthest is 1: byte 126
  EvidenceMap seen(64, 0.1, {1.0, 2.0});
  seen.add({10, 20}, -6);
  seen.add({11, 20}, -6);
  FieldPicture picture;
  draw(picture, {.low = {10, 20}, .width = 2, .height = 3, .cell_m = 0.1, .psi = psi}, seen);
  CHECK(to_json(picture, 3) ==
        R"({"kind":"field","number":3,"x":1.0,"y":2.0,"cell_m":0.1,"width":2,"cells":"AH7//n/9"})");
}

TEST_CASE("the scan lies where the robot was when it was taken, not where it has driven since") {
  const auto snapshot = std::make_unique<ViewSnapshot>();
  LaserScan& scan = snapshot->record.scan;
  scan.beam_count = 3;
  scan.first_angle_rad = -0.5F;
  scan.angle_step_rad = 0.5F;
  scan.range_max_m = 10.0F;
  scan.range_m[1] = 2.0F;  // straight ahead of a laser 0.25 m before the robot's middle; the others see nothing
  snapshot->map_from_robot_at_scan[0] = {1.0, 0.0, 0.0};
  snapshot->record.pose.map_from_robot = {1.5, 0.0, 0.25};
  CHECK(to_json(*snapshot, LaserModel{.robot_from_laser = {0.25, 0.0, 0.0}}).find(R"({"hits":[3.25,0.0],)") == 0);
}

TEST_CASE("a known map is thinned to 1,000 cells a side, and none of its walls gets lost") {
  KnownMap known{0.1, {-20, 0}, 4000, 4, std::vector<KnownCell>(16'000, KnownCell::kFree)};
  known.cells[known.index({-20 + 2003, 2})] = KnownCell::kWall;
  known.cells[known.index({-20, 0})] = KnownCell::kUnknown;
  const std::string hello = to_json(HelloScene{.title = "", .known = &known}, {}, true);
  CHECK(hello.find(R"("ground":{"x":-2.0,"y":0.0,"cell_m":0.4,"width":1000,"cells":"AQEB)") != std::string::npos);
  CHECK(hello.find("AQEC") != std::string::npos);  // 1 1 2: cell 500, which is the third of its three
  CHECK(to_json(HelloScene{.title = ""}, {}, true).find(R"("ground":null)") != std::string::npos);
}

TEST_CASE("a field of 1,024 cells a side is thinned to 128") {
  const std::vector<float> psi(1024 * 1024, 1.0F);
  FieldPicture picture;
  draw(picture, {.low = {}, .width = 1024, .height = 1024, .cell_m = 0.1, .psi = psi}, EvidenceMap(64, 0.1, {}));
  CHECK(picture.width == 128);
  CHECK(picture.cells.size() == 128 * 128);
  CHECK(picture.cell_m == 0.8);
}

TEST_CASE("any tick that was kept comes back with its scene and its field") {
  FrameStore store;
  CHECK(store.then(0).empty());
  store.add_scene("{\"a\":1}");
  store.add({.t_s = 0.5,
             .wanted_mps = 0.25,
             .permitted_mps = 0.125,
             .speed_mps = 0.5,
             .at = {1.5, -2.0},
             .reasons = Reason::kNoGoal | Reason::kStopZone},
            "{\"tick\":0,\"scene\":");
  store.add_field("{\"f\":2}");
  store.add({.t_s = 1.0}, "{\"tick\":1,\"scene\":");
  CHECK(store.then(0) == R"({"kind":"then","frame":{"tick":0,"scene":{"a":1}},"field":null})");
  CHECK(store.then(1) == R"({"kind":"then","frame":{"tick":1,"scene":{"a":1}},"field":{"f":2}})");
  CHECK(store.then(2).empty());
  CHECK(
      store.past(9) ==
      R"({"kind":"past","step":1,"ticks":[[0.50,0.250,0.125,0.500,"stop_zone|no_goal",1.50,-2.00],[1.00,0.000,0.000,0.000,"",0.00,0.00]]})");
  CHECK(store.past(1) ==
        R"({"kind":"past","step":2,"ticks":[[0.50,0.250,0.125,0.500,"stop_zone|no_goal",1.50,-2.00]]})");
}

TEST_CASE("a PoseStamped in JSON is a goal where it turns in the plane of the map") {
  const auto goal = goal_from_json(
      R"({"header":{"frame_id":"map"},"pose":{"position":{"x":1,"y":2,"z":0},"orientation":{"x":0,"y":0,"z":1,"w":0}}})");
  REQUIRE(goal);
  CHECK(goal->position_in_map == Vec2{1.0, 2.0});
  CHECK(std::fabs(goal->heading_rad - 3.14159265358979) < 1e-12);
  CHECK(to_json(GoalOrder{.position_in_map = {1.5, -2.0}}) == R"({"goal":[1.5,-2]})");
  CHECK(to_json(GoalOrder{.position_in_map = {1.5, -2.0}, .heading_rad = 0.5}, "here") == R"({"here":[1.5,-2,0.5]})");
  CHECK(goal_from_json(R"({"pose":{"pose":{"position":{"x":1,"y":2}},"covariance":[]}})")->position_in_map ==
        Vec2{1.0, 2.0});
  CHECK(std::isnan(goal_from_json(R"({"pose":{"position":{"x":1,"y":2}}})")->heading_rad));
  for (const char* text : {"", "{}", "[]", R"({"pose":{}})", R"({"pose":1})",
                           R"({"header":{"frame_id":"odom"},"pose":{"position":{"x":1,"y":2}}})",
                           R"({"header":{"frame_id":7},"pose":{"position":{"x":1,"y":2}}})",
                           R"({"pose":{"position":{"x":1},"orientation":{"x":1}}})"}) {
    INFO(text);
    CHECK_FALSE(goal_from_json(text));
  }
}

TEST_CASE("a PoseStamped in CDR that is cut anywhere is no goal") {
  const double numbers[] = {3.0, 4.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  std::string whole("\0\1\0\0\0\0\0\0\0\0\0\0\4\0\0\0map\0", 20);  // its numbers begin at 16 of the body
  whole.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
  REQUIRE(goal_from_cdr(whole));
  CHECK(goal_from_cdr(whole)->position_in_map == Vec2{3.0, 4.0});
  CHECK(goal_from_cdr(whole)->heading_rad == 0.0);
  for (std::size_t size = 0; size < whole.size(); ++size) CHECK_FALSE(goal_from_cdr(whole.substr(0, size)));
  const std::string with_covariance = whole + std::string(36 * sizeof(double), '\0');
  CHECK(goal_from_cdr(with_covariance)->position_in_map == Vec2{3.0, 4.0});
  whole[12] = '\xFF';  // a frame of 255 letters
  CHECK_FALSE(goal_from_cdr(whole));
}

TEST_CASE("Foxglove's pose estimate says where the robot is, and an answer is a status") {
  FoxgloveSession session(1);
  static_cast<void>(session.take_text(
      R"({"op":"advertise","channels":[{"id":4,"topic":"/initialpose","encoding":"json","schemaName":"x"}]})"));
  const std::string head("\1\4\0\0\0", 5);
  const auto outcome = session.take_binary(
      head + R"({"pose":{"pose":{"position":{"x":1,"y":2},"orientation":{"z":1,"w":0}},"covariance":[]}})");
  CHECK(outcome.order == R"({"here":[1,2,3.14159265]})");
  CHECK(session.take_binary(head + "{}").status.find("/initialpose: no pose") != std::string::npos);
  CHECK(foxglove_answer(R"({"kind":"said","text":"refused: it does not fit"})") ==
        R"({"level":1,"message":"refused: it does not fit","op":"status"})");
  CHECK(foxglove_answer(R"({"kind":"said","text":"going"})") == R"({"level":0,"message":"going","op":"status"})");
}

TEST_CASE("Foxglove's service /stop stops, and is answered in the encoding that it was asked in") {
  FoxgloveSession session(1);
  CHECK(foxglove_greeting({}).back().find(R"("name":"/stop")") != std::string::npos);
  const auto call = [](const std::string& encoding, char service = 0) {
    return std::string{'\2', service, 0, 0, 0, 7, 0, 0, 0, static_cast<char>(encoding.size()), 0, 0, 0} + encoding;
  };
  for (const std::string encoding : {"cdr", "json"}) {
    const auto outcome = session.take_binary(call(encoding) + "x");
    CHECK(outcome.order == R"({"stop":true})");
    const std::string head = outcome.call;
    CHECK(head == call(encoding));
    const std::string answer = foxglove_service_answer(head, R"({"kind":"said","text":"stopping"})");
    CHECK(answer.starts_with("\3" + head.substr(1)));
    const std::string body = answer.substr(head.size());
    CHECK(body == (encoding == "json" ? R"({"message":"stopping","success":true})"
                                      : std::string("\0\1\0\0\1\0\0\0\x9\0\0\0stopping\0", 21)));
  }
  CHECK(foxglove_service_answer(call("json"), R"({"text":"refused: no"})").ends_with(R"("success":false})"));
  for (const std::string& wrong : {call("cdr", 1), call("xml"), call("cdr").substr(0, 14), std::string("\2")}) {
    CHECK(session.take_binary(wrong).order.empty());
    CHECK_FALSE(session.take_binary(wrong).status.empty());
  }
}

TEST_CASE("Foxglove's parameters are read, all or by name, and setting one tells the old value") {
  const std::vector<FoxgloveParameter> parameters{{"/jaywalk.a", 0.5}, {"/jaywalk.b", 2.0}};
  FoxgloveSession session(1, parameters);
  const std::string a = R"({"name":"/jaywalk.a","type":"float64","value":0.5})";
  const std::string b = R"({"name":"/jaywalk.b","type":"float64","value":2.0})";
  const auto values = [](const std::string& listed) {
    return R"({"id":"7","op":"parameterValues","parameters":[)" + listed + "]}";
  };
  CHECK(session.take_text(R"({"op":"getParameters","id":"7"})").status == values(a + "," + b));
  CHECK(session.take_text(R"({"op":"getParameters","parameterNames":["/jaywalk.b","/other",3],"id":"7"})").status ==
        values(b));
  CHECK(session.take_text(R"({"op":"setParameters","parameters":[{"name":"/jaywalk.a","value":9}],"id":"7"})").status ==
        values(a + "," + b));
  CHECK(foxglove_time(Time{std::chrono::nanoseconds(0x0102)}) == std::string("\2\2\1\0\0\0\0\0\0", 9));
}

TEST_CASE("Foxglove's client messages that are none are told, and subscribe to nothing") {
  FoxgloveSession session(3);
  for (const char* text :
       {"", "[]", "{}", R"({"op":"jump"})", R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":3}]})",
        R"({"op":"subscribe","subscriptions":[7]})"}) {
    INFO(text);
    CHECK_FALSE(session.take_text(text).status.empty());
  }
  CHECK(session.wanted() == 0);
  CHECK(session.take_text(R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":2}]})").subscribed.size() == 1);
  const auto again = session.take_text(
      R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":2},{"id":8,"channelId":2},{"id":9,"channelId":2}]})");
  CHECK(again.subscribed.empty());
  CHECK_FALSE(again.status.empty());
  CHECK(session.wanted() == 4);
  CHECK(session.subscription(2) == 9U);
  CHECK(session.take_text(R"({"op":"unsubscribe","subscriptionIds":[9,"x"]})").status.empty());
  CHECK(session.wanted() == 0);
}
