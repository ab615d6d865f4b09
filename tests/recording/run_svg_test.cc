#include <regex>

#include "apps/report/picture/run_layers.h"
#include "apps/report/picture/scene.h"
#include "hal/types/errors.h"
#include "tests/recording/made_scene.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk {
namespace {

/// Every element that opens is closed, in order, and no '&' stands alone: all that this writer could do wrong.
bool is_well_formed(const std::string& xml) {
  static const std::regex kTag("<(/?)([A-Za-z]+)((?: [A-Za-z:-]+=\"[^\"<]*\")*)(/?)>");
  std::vector<std::string> open;
  for (std::sregex_iterator tag(xml.begin(), xml.end(), kTag), end; tag != end; ++tag) {
    if ((*tag)[1] == "/") {
      if (open.empty() || open.back() != (*tag)[2]) return false;
      open.pop_back();
    } else if ((*tag)[4] != "/") {
      open.push_back((*tag)[2]);
    }
  }
  const std::string rest = std::regex_replace(std::regex_replace(xml, kTag, ""), std::regex("&(amp|lt|gt|quot);"), "");
  return open.empty() && rest.find_first_of("<>&") == std::string::npos;
}

/// The last two numbers of the first "translate" animation after `id`.
Vec2 last_place(const std::string& svg, const std::string& id) {
  const std::size_t begin = svg.find("values=\"", svg.find("id=\"" + id + "\"")) + 8;
  const std::string values = svg.substr(begin, svg.find('"', begin) - begin);
  const std::string last = values.substr(values.rfind(';') + 1);
  return {std::stod(last), std::stod(last.substr(last.find(' ')))};
}

/// Bodies that turn all the time, in a run of `seconds`, with a wall piece and an occupied cell for each of `pieces`.
PictureScene busy_scene(double seconds, int movers, int pieces) {
  PictureScene scene = made_scene();
  scene.driven.clear();
  scene.movers.clear();
  for (double t = 0.0; t < seconds; t += 0.2) {
    scene.driven.push_back({time_from_seconds(t), {8.0 + 7.0 * sin(t), 6.0 + 5.0 * cos(0.7 * t), 0.5 * t}});
  }
  const int points = static_cast<int>(seconds * 5.0);
  for (int id = 0; id < movers; ++id)
    scene.movers.push_back(made_trail(static_cast<std::uint32_t>(id), {9, 9}, {}, points));
  for (int i = 0; i < pieces; ++i) {
    scene.walls.push_back({{0.01 * i, 1.0}, {0.01 * i, 2.0}});
    scene.occupied.push_back({0.2 * (i % 400), 0.2 * (i / 400)});
  }
  return scene;
}

TEST_CASE("a moving picture is XML without a script, and repeats") {
  PictureScene scene = made_scene();
  scene.title = "<script>alert(1)</script> & \"\x1b[31m\" \xff";
  const std::string svg = svg_of(scene);
  CHECK(is_well_formed(svg));
  CHECK_FALSE(is_well_formed(svg + "</g>"));
  CHECK(svg.find("<script") == std::string::npos);
  CHECK(svg.find('\x1b') == std::string::npos);
  CHECK(svg.find(" on") == std::string::npos);
  // Five movers and where they are expected, the robot's place and heading, its way, the clock.
  CHECK(count_of("repeatCount=\"indefinite\"", svg) == 14);
  CHECK(svg == svg_of(scene));
  CHECK(count_of("<text font-size=\"22\"", svg) == 5);  // each mover has its number
}

TEST_CASE("the robot ends where the run ended, at the goal's side of the map") {
  // The extent is 17.2 m x 13.2 m (walls and 0.6 m round them), 1600 units wide: 93.02 a metre. The last pose is
  // (14, 9): x = 20 + (14 + 0.6) * 93.02 = 1378, y = 80 + (12.6 - 9) * 93.02 = 415.
  const Vec2 end = last_place(svg_of(made_scene()), "robot");
  CHECK(end.x == 1378);
  CHECK(end.y == 415);
}

TEST_CASE("a moving picture shows where bodies are expected in 2 s, and the ground that the laser sees") {
  PictureScene scene;
  scene.walls = {{{0, 0}, {10, 0}}, {{10, 0}, {10, 5}}};
  // 0.5 m/s towards the wall at x = 10, which it touches 0.8 m on.
  Trail trail{7, 0.2, false, {}};
  for (int k = 0; k < 9; ++k) trail.points.push_back({time_from_seconds(0.4 * k), {7.4 + 0.2 * k, 2.0}});
  scene.movers = {trail};
  LaserScan scan;
  scan.sequence = 1, scan.beam_count = 79, scan.first_angle_rad = -1.56F, scan.angle_step_rad = 0.04F;
  scan.range_max_m = 9.0F, scan.range_m.fill(2.0F);
  scan.range_m[40] = 12.0F;  // at 0.04 rad nothing in reach
  DrivenWay way;
  for (int k = 0; k < 9; ++k) way.add(time_from_seconds(0.4 * k), {1.0, 2.0, 0.0}, k == 0 ? LaserScan{} : scan);
  scene.driven = way.poses();
  scene.robot_from_laser = {0.5, 0.0, 0.0};
  scene.extent = {{0.0, 0.0}, {10.0, 5.0}};
  const std::string svg = svg_of(scene);  // 1600 units for 10 m
  CHECK(is_well_formed(svg));
  CHECK(last_place(svg, "robot").x == 180);
  const std::size_t expected = svg.find("class=\"expected\"");
  REQUIRE(expected != std::string::npos);
  const std::size_t ways = svg.find("values=\"", expected) + 8;
  const std::string ahead = svg.substr(ways, svg.find('"', ways) - ways);
  CHECK(ahead.starts_with("0 0;160 0;160 0;"));
  CHECK(std::stod(ahead.substr(ahead.rfind(';') + 1)) == Approx(124.0).margin(4.1));
  const std::size_t laser = svg.find("id=\"laser\"");
  REQUIRE(laser != std::string::npos);
  // The laser at 1.5, 2 m; at -1.56 rad a wall 2 m off, at 0.04 rad the end of its reach, 9 m.
  CHECK(svg.find("values=\"M260 560 263 880 ", laser) != std::string::npos);
  CHECK(svg.find(" 1699 502 ", laser) != std::string::npos);
}

TEST_CASE("a moving picture stays below its size: long runs, many movers, many walls") {
  CHECK(svg_of(busy_scene(45.0, 16, 0)).size() < 40'000);
  PictureScene long_run = busy_scene(3600.0, 300, 30'000);
  CHECK(svg_of(long_run).size() < 100'000);
  long_run.walls.clear();
  CHECK(svg_of(long_run).size() < 100'000);
  CHECK(svg_of(long_run).find("shown 60.0 times faster") != std::string::npos);
}

TEST_CASE("an empty scene and a single pose give a picture") {
  PictureScene scene;
  scene.extent = extent_of(scene);
  CHECK(is_well_formed(svg_of(scene)));
  scene.driven.push_back({time_from_seconds(5), {1, 2, 3}});
  CHECK(is_well_formed(svg_of(scene)));
  CHECK_THROWS_AS(draw_svg(scene, "/nowhere/at/all/run.svg"), StartupError);
}

TEST_CASE("a robot that turns past pi goes on turning the same way") {
  // Headings 3.0, -3.0 (= 3.283): the short way is 0.283 on, not 6 back.
  const std::vector<DrivenPose> driven{{time_from_seconds(0), {0, 0, 3.0}}, {time_from_seconds(0.4), {0, 0, -3.0}}};
  const auto poses = Playback(driven, 100).robot();
  REQUIRE(poses.size() == 2);
  CHECK(poses[1].heading == Approx(3.2832).margin(1e-4));
}

TEST_CASE("a mover is where it was at the moment asked for, and nowhere before it came and after it left") {
  const Trail trail{1, 0.27, false, {{time_from_seconds(2), {0, 0}}, {time_from_seconds(4), {1, 0}}}};
  CHECK_FALSE(position_at(trail, time_from_seconds(1.9)).has_value());
  CHECK(position_at(trail, time_from_seconds(3))->x == Approx(0.5));
  CHECK(position_at(trail, time_from_seconds(4.5))->x == 1.0);
  CHECK_FALSE(position_at(trail, time_from_seconds(5.1)).has_value());
}

TEST_CASE("nobody is shown as expected in or behind a wall") {
  PictureScene scene;
  scene.walls.push_back({{2, -1}, {2, 1}});
  CHECK(end_before_wall(scene, {0, 0}, {5, 0}, 0.2).x == Approx(1.8).margin(0.051));
  CHECK(end_before_wall(scene, {0, 0}, {1.5, 0}, 0.2) == Vec2{1.5, 0});
  CHECK(end_before_wall(scene, {1.9, 0}, {5, 0}, 0.2) == Vec2{1.9, 0});
  scene.walls.clear();
  scene.occupied.push_back({1, 0});
  CHECK(end_before_wall(scene, {0, 0}, {5, 0}, 0.2).x < 0.85);
}

}  // namespace
}  // namespace jaywalk
