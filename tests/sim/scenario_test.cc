#include <cmath>

#include "hal/robot_model_file.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

const std::string kModel = kBody + "[laser]\n" + kScanner;
const std::string kBeamsLost = "[[faults]]\nat_s = 1\nfor_s = 2\nkind = \"beams_lost\"\n";

/// The refusal of a robot's own file.
std::string refused_robot(const std::string& text) {
  return refusal_of([&text] { return load_robot_model(folder().write("robot.toml", text)); });
}

}  // namespace

TEST_CASE("a scenario says everything that it says") {
  folder().write("body.toml", kModel);
  const Scenario s = parsed(
      "name = \"all\"\nseed = 7\ntimeout_s = 60\n" + kMap + kRobot +
      "goal_tolerance_m = 0.5\nmodel = \"wheelchair\"\nmax_speed_mps = 1.1\n"
      "[robot.laser]\nfov_deg = 180\nbeams = 361\nrate_hz = 20\nrange_m = 8\nnoise_m = 0.02\n"
      "drop_out = 0.1\n[robot.slip]\nmean = 0.05\nstd = 0.02\n[robot.pose_source]\nrate_hz = 4\nposition_std_m = 0.2\n"
      "[[movers]]\nkind = \"wander\"\ncount = 3\nspeed_mps = 0.7\nradius_m = 0.3\n"
      "turn_rate_radps = 2\nspontaneous_turns_hz = 0.1\nlegs = true\n"
      "[[movers]]\nkind = \"recorded\"\nfile = \"walk.csv\"\noffset = [1, 2]\nloop = true\nlegs = true\n"
      "start_at_s = 3\n[[faults]]\nkind = \"scan_stale\"\nat_s = 1\nfor_s = 0.5\n");
  CHECK(s.name == "all");
  CHECK(s.seed == 7);
  CHECK(s.timeout_s == 60.0);
  CHECK(s.map_kind == MapKind::kAria);
  CHECK(s.start == Pose2{5, 5, 0});
  CHECK(s.goal == Vec2{8, 8});
  CHECK(holds(s.start_place, "s.toml:7: "));  // three lines, two of [map], [robot], start
  CHECK(holds(s.goal_place, "s.toml:8: "));
  CHECK(s.goal_tolerance_m == 0.5);
  CHECK(s.model.name == "wheelchair");
  CHECK(s.model.limits.max_speed_mps == 1.1);
  CHECK(s.model.laser.fov_rad == Approx(kPi));
  CHECK(s.model.laser.beams == 361);
  CHECK(s.model.laser.drop_out == 0.1);
  CHECK(s.model.laser.robot_from_laser.x == wheelchair().laser.robot_from_laser.x);
  CHECK(s.slip.mean == 0.05);
  CHECK(s.slip.std == 0.02);
  CHECK(s.pose_source.enabled);
  CHECK(s.pose_source.rate_hz == 4.0);
  REQUIRE(s.wanderers.size() == 1);
  CHECK(s.wanderers[0].count == 3);
  CHECK(s.wanderers[0].turn_rate_radps == 2.0);
  CHECK(s.wanderers[0].legs);
  REQUIRE(s.recorded.size() == 1);
  CHECK(s.recorded[0].offset == Vec2{1, 2});
  CHECK(s.recorded[0].loop);
  CHECK(s.recorded[0].legs);
  REQUIRE(s.faults.size() == 1);
  CHECK(s.faults[0].for_s == 0.5);
}

TEST_CASE("a short scenario gets a P3-DX, nobody moving and no outside fixes") {
  const Scenario s = parsed(kMap + kRobot);
  CHECK(s.name == "s");
  CHECK(s.seed == 1);
  CHECK(s.model.name == "p3dx");
  CHECK(s.wanderers.empty());
  CHECK_FALSE(s.pose_source.enabled);
  CHECK(s.slip.mean == 0.0);
  CHECK(s.slip.std == 0.005);
  CHECK(std::isnan(s.goal_heading_rad));
}

TEST_CASE("a stick drives straight, to the goal or by a table") {
  folder().write("stick.csv", "t_s,forward,left\n0,0.5,0\n2,0,-1\n");
  CHECK_FALSE(parsed(kMap + kRobot).stick);
  const Scenario straight = parsed(kMap + kRobot + "[stick]\nkind = \"straight\"\nforward = 0.5\nnoise_std = 0.1\n");
  REQUIRE(straight.stick);
  CHECK(straight.stick->kind == StickKind::kStraight);
  CHECK(straight.stick->steering == StickUse::kShared);
  CHECK(straight.stick->forward == 0.5);
  CHECK(straight.stick->noise_std == 0.1);
  const Scenario table =
      parsed(kMap + kRobot + "[stick]\nkind = \"table\"\nfile = \"stick.csv\"\nsteering = \"by_hand\"\n");
  CHECK(table.stick->kind == StickKind::kTable);
  CHECK(table.stick->steering == StickUse::kByHand);
}

TEST_CASE("a goal may have a heading, and a tolerance for it") {
  const Scenario s = parsed(kMap + "[robot]\nstart = [5, 5, 0]\ngoal = [8, 8, -4]\ngoal_heading_tolerance_rad = 0.2\n");
  CHECK(s.goal == Vec2{8, 8});
  CHECK(s.goal_heading_rad == Approx(2.0 * kPi - 4.0));
  CHECK(s.goal_heading_tolerance_rad == 0.2);
}

TEST_CASE("bad scenarios are refused with file, line and cause") {
  const std::string good = kMap + kRobot;  // five lines
  const std::vector<Bad> cases{
      {"", "s.toml:1: map is missing"},
      {"[map\n", "s.toml:1: "},
      {"\nname = " + std::string(20000, '['), "s.toml:2: brackets within brackets"},
      {kMap, "s.toml:1: robot is missing"},
      {"[map]\n" + kRobot, "s.toml:1: map.yaml or aria or cylinders: one is needed"},
      {"[map]\naria = \"room.map\"\ncylinders = \"room.map\"\n" + kRobot, "one is needed"},
      {"[map]\naria = \"none.map\"\n" + kRobot, "s.toml:2: map.aria names "},
      {"[map]\naria = 3\n" + kRobot, "s.toml:2: map.aria is not a text"},
      {"map = 3\n" + kRobot, "s.toml:1: map is not a table"},
      {"[map]\naria = \"room.map\"\nscale = 2\n" + kRobot, "s.toml:3: map.scale is not a known key"},
      {"speed = 3\n" + good, "s.toml:1: speed is not a known key"},
      {"seed = -1\n" + good, "s.toml:1: seed is -1"},
      {"seed = 1.5\n" + good, "s.toml:1: seed is not a whole number"},
      {"timeout_s = \"long\"\n" + good, "s.toml:1: timeout_s is not a number"},
      {"timeout_s = nan\n" + good, "s.toml:1: timeout_s is nan"},
      {"timeout_s = inf\n" + good, "s.toml:1: timeout_s is inf"},
      {kMap + "[robot]\ngoal = [8, 8]\n", "s.toml:3: robot.start is missing"},
      {kMap + "[robot]\nstart = [5, 5]\ngoal = [8, 8]\n", "s.toml:4: robot.start has 2 elements"},
      {kMap + "[robot]\nstart = [5, 5, nan]\ngoal = [8, 8]\n", "s.toml:4: robot.start holds what is no number"},
      {kMap + "[robot]\nstart = [5, 5, 0]\ngoal = 8\n", "s.toml:5: robot.goal is not an array"},
      {kMap + "[robot]\nstart = [5, 5, 0]\ngoal = [8, 8, 0, 0]\n",
       "s.toml:5: robot.goal has 4 elements; write [ ] with 2 or 3 numbers"},
      {kMap + "[robot]\nstart = [5, 5, 0]\ngoal = [8, 8, nan]\n", "s.toml:5: robot.goal holds what is no number"},
      {good + "goal_heading_tolerance_rad = 0\n", "s.toml:6: robot.goal_heading_tolerance_rad is 0"},
      {good + "model = \"tank\"\n", "s.toml:6: robot.model names "},
      {good + "max_speed_mps = 9\n", "s.toml:6: robot.max_speed_mps is 9"},
      {good + "goal_tolerance_m = 0\n", "s.toml:6: robot.goal_tolerance_m is 0"},
      {good + "[robot.laser]\nbeams = 5000\n", "s.toml:7: robot.laser.beams is 5000"},
      {good + "[robot.laser]\nmount = [1e9, 0, 0]\n", "s.toml:7: robot.laser.mount lies at 1e+09 m"},
      {good + "[robot.laser]\nmount = [11, 0, 0]\n", "s.toml:7: robot.laser.mount lies beside any robot"},
      {good + "[robot.laser]\nmount = [0, 0, 90]\n", "s.toml:7: robot.laser.mount has the heading 90 rad"},
      {kMap + "[robot]\nstart = [5, 5, 180.0]\ngoal = [8, 8]\n", "degrees are 3.14159"},
      {kMap + "[robot]\nstart = [5, 5, 0]\ngoal = [8, -1e300]\n", "s.toml:5: robot.goal lies at -1e+300 m"},
      {"name = \"a\\u001B[31m\"\n" + good, "s.toml:1: name holds a control character"},
      {"timeout = 3\n" + good, "s.toml:1: timeout is not a known key; did you mean timeout_s?"},
      {good + "[robot.laser]\nfov_deg = 400\n", "s.toml:7: robot.laser.fov_deg is 400"},
      {good + "[robot.laser]\ncolour = 1\n", "s.toml:7: robot.laser.colour is not a known key"},
      {good + "[robot.laser]\nrange_min_m = 3\nrange_m = 2\n", "s.toml:7: robot.laser.range_min_m is not below"},
      {good + "[[robot.laser.blanked]]\nfrom_deg = 10\n", "s.toml:6: robot.laser.blanked.to_deg is missing"},
      {good + "[[robot.laser.blanked]]\nfrom_deg = 10\nto_deg = 370\n", "s.toml:8: robot.laser.blanked.to_deg is 370"},
      {good + "[[robot.laser.blanked]]\nfrom_deg = -180\nto_deg = 180\n",
       "s.toml:8: robot.laser.blanked.to_deg is where the sector begins"},
      {good + "[[robot.laser.blanked]]\nfrom = 10\n", "robot.laser.blanked.from_deg is missing"},
      {good + "[robot.slip]\nmean = 0.6\n", "s.toml:7: robot.slip.mean"},
      {good + "[robot.pose_source]\nenabled = 1\n", "s.toml:7: robot.pose_source.enabled is not true or false"},
      {good + "[movers]\nkind = \"wander\"\n", "s.toml:6: movers is not a list of tables"},
      {good + "[[movers]]\ncount = 3\n", "s.toml:6: movers.kind is missing"},
      {good + "[[movers]]\nkind = \"fly\"\n", "s.toml:7: movers.kind is \"fly\""},
      {good + "[[movers]]\nkind = \"wander\"\n", "s.toml:6: movers.count is missing"},
      {good + "[[movers]]\nkind = \"wander\"\ncount = -1\n", "s.toml:8: movers.count is -1"},
      {good + "[[movers]]\nkind = \"wander\"\ncount = 1\nfile = \"walk.csv\"\n",
       "s.toml:9: movers.file is not a known"},
      {good + "[[movers]]\nkind = \"recorded\"\n", "s.toml:6: movers.file is missing"},
      {good + "[[movers]]\nkind = \"recorded\"\nfile = \"no.csv\"\n", "s.toml:8: movers.file names "},
      {good + "[[faults]]\nkind = \"fire\"\nat_s = 1\nfor_s = 1\n", "s.toml:7: faults.kind is \"fire\""},
      {good + "[[faults]]\nkind = \"scan_nan\"\nat_s = 1\n", "s.toml:6: faults.for_s is missing"},
      {good + kBeamsLost + "from_deg = -100\n", "faults.to_deg is missing"},
      {good + "[[faults]]\nat_s = 1\nfor_s = 2\nkind = \"scan_nan\"\nfrom_deg = 1\n", "faults.from_deg is not a known"},
      {good + "[stick]\nkind = \"loop\"\n", "stick.kind"},
      {good + "[stick]\nkind = \"straight\"\nfile = \"walk.csv\"\n", "stick.file is not a known key"}};
  check_refused(cases, refused);
}

TEST_CASE("a file that cannot be read is refused by its place, cause and remedy, whatever it is") {
  check_refused({{"/tmp", "/tmp: a folder; give the path of a TOML file"},
                 {"/dev/zero", "/dev/zero: no regular file; give"},
                 {"/proc/self/mem", "/proc/self/mem: cannot be read to its end; give"},  // once opened
                 {"/nowhere.toml", "/nowhere.toml: no such file"}},
                [](const std::string& file) { return refusal_of([&file] { return load_scenario(file); }); });
}

TEST_CASE("lost beams are those of the named sector, or else of the 120 degrees ahead") {
  CHECK(parsed(kMap + kRobot + kBeamsLost).faults[0].lost.width_rad() == Approx(2.0 * kPi / 3.0));
  const FaultSpec named = parsed(kMap + kRobot + kBeamsLost + "from_deg = -100\nto_deg = 30\n").faults[0];
  CHECK(named.kind == FaultKind::kBeamsLost);
  CHECK(named.lost.from_rad == Approx(-100.0 * kPi / 180.0));
  CHECK(named.lost.to_rad == Approx(30.0 * kPi / 180.0));
}

TEST_CASE("two beams are no scanner, in a scenario nor in a robot's own file") {
  CHECK(holds(refused(kMap + kRobot + "[robot.laser]\nbeams = 2\n"), "robot.laser.beams are too few"));
  CHECK(parsed(kMap + kRobot + "[robot.laser]\nbeams = 3\n").model.laser.beams == 3);
  std::string body = kModel;
  body.replace(body.find("181"), 3, "2");
  CHECK(holds(refused_robot(body), "laser.beams are too few"));
}

TEST_CASE("sectors in which the laser sees the robot are read in degrees, sixteen at most") {
  const std::string sector = "[[robot.laser.blanked]]\nfrom_deg = 170\nto_deg = -170\n";
  std::string text = kMap + kRobot;
  for (int k = 0; k < 16; ++k) text += sector;
  const Blanking blanked = parsed(text).model.laser.blanked;
  REQUIRE(blanked.size() == 16);
  CHECK(blanked[3].width_rad() == Approx(20.0 * kPi / 180.0));
  const std::string message = refused(text + sector);
  CHECK(holds(message, "robot.laser.blanked.from_deg begins one sector more than 16"));
}

TEST_CASE("a robot's own file gives body, drive, limits and laser") {
  folder().write("body.toml", kModel);
  const RobotModel model = parsed(kMap + kRobot + "model = \"body.toml\"\n").model;
  CHECK(model.name == "body");
  CHECK(model.footprint.front_m == 0.3);
  CHECK(model.drive.max_wheel_speed_radps == 10.0);
  CHECK(model.limits.brake_mps2 == 0.9);
  CHECK(model.laser.robot_from_laser == Pose2{0.1, 0.0, 3.0});
  CHECK(model.laser.drop_out == 0.0);
}

TEST_CASE("a robot's own blanked sectors hold where the scenario has none, else the scenario's do") {
  const std::string own = "[[laser.blanked]]\nfrom_deg = 10\nto_deg = 20\n";
  folder().write("posts.toml", kModel + own);
  const std::string text = kMap + kRobot + "model = \"posts.toml\"\n";
  CHECK(parsed(text).model.laser.blanked[0].to_rad == Approx(20.0 * kPi / 180.0));
  const std::string others = "[[robot.laser.blanked]]\nfrom_deg = 30\nto_deg = 40\n";
  const Blanking blanked = parsed(text + others).model.laser.blanked;
  REQUIRE(blanked.size() == 1);
  CHECK(blanked[0].to_rad == Approx(40.0 * kPi / 180.0));
}

TEST_CASE("a bad robot file is refused with its own name and line") {
  check_refused({{"[footprint]\nfront_m = 0.3\n", "robot.toml:1: footprint.rear_m is missing"},
                 {"[footprint]\nfront_m = -1\n", "robot.toml:2: footprint.front_m is -1"},
                 {kModel + "colour = 1\n", "laser.colour is not a known key"},
                 {"wheels = 4\n" + kModel, "robot.toml:1: wheels is not a known key"},
                 {kModel.substr(0, kModel.find("beams")), "laser.beams is missing"}},
                refused_robot);
}

TEST_CASE("a setting beside the file stands in place of its own") {
  const auto file = folder().write("s.toml", kMap + kRobot +
                                                 "[[movers]]\nkind = \"wander\"\ncount = 3\n"
                                                 "[[movers]]\nkind = \"recorded\"\nfile = \"walk.csv\"\n");
  const Scenario s = load_scenario(file, {"movers.count=16", "movers.legs=true", "robot.laser.fov_deg=180",
                                          "robot.slip.mean=1e-2", "robot.goal=7,6.5", "robot.model=wheelchair"});
  CHECK(s.wanderers.at(0).count == 16);
  CHECK(s.wanderers.at(0).legs);
  CHECK(s.recorded.at(0).legs);
  CHECK(s.model.laser.fov_rad == Approx(kPi));
  CHECK(s.slip.mean == 0.01);
  CHECK(s.goal == Vec2{7.0, 6.5});
  CHECK(s.model.name == "wheelchair");
}

TEST_CASE("a setting that nothing can take is refused with its own words") {
  const auto file = folder().write("s.toml", kMap + kRobot + "[[movers]]\nkind = \"recorded\"\nfile = \"walk.csv\"\n");
  check_refused({{"movers.count=4", "s.toml has no [[movers]] that may hold it; "},
                 {"movers.cuont=4", "did you mean movers.count?"},
                 {"timeout_s", "is no KEY=VALUE; "},
                 {"timeout_s=007", "no value that TOML knows; "},
                 {"timeout_s=0", "--set timeout_s=0: timeout_s is 0; choose a value from 0.1 to 86400"},
                 {"name=it's", "holds a quote"}},
                [&](const std::string& setting) { return refusal_of([&] { return load_scenario(file, {setting}); }); });
}
