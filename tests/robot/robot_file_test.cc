#include <cmath>

#include "tests/robot/robot_file_text.h"

using namespace jaywalk;
using namespace jaywalk::tests;

namespace {

const std::string kDrive = "cia402\"\ncan = \"can0\"\ncounts_per_wheel_turn = 76600",
                  kReversed = "\nright_reversed = true";

/// Another kind of motors on the same bus.
std::string motors(const std::string& kind, const std::string& turns_line) {
  return with(kDrive, kind + "\"\ncan = \"can0\"\n" + turns_line);
}

/// Another drive, without a bus.
std::string drive_of(const std::string& kind, const std::string& keys) {
  return with(kDrive + kReversed, kind + "\"\n" + keys);
}

std::string more_of_drive(const std::string& keys) { return with("can = \"can0\"", "can = \"can0\"\n" + keys); }

}  // namespace

TEST_CASE("places have names of their own, with a heading or without") {
  const std::string two = kGood + "[[places]]\nname = \"kitchen\"\nat = [4.0, 1.5, 1.57]\n" +
                          "[[places]]\nname = \"bed-2\"\nat = [-1.0, 2.0]\n";
  const RobotFile robot = load(two);
  REQUIRE(robot.places.size() == 2);
  CHECK(robot.places[0].name == "kitchen");
  CHECK(robot.places[0].order.position_in_map == Vec2{4.0, 1.5});
  CHECK(robot.places[0].order.heading_rad == 1.57);
  CHECK(robot.places[1].name == "bed-2");
  CHECK(std::isnan(robot.places[1].order.heading_rad));
  CHECK(holds(refusal(two + "[[places]]\nname = \"kitchen\"\nat = [0, 0]\n"), "is another place's already"));
  CHECK(holds(refusal(two + "[[places]]\nname = \"2nd bed\"\nat = [0, 0]\n"), "is no name for a place"));
  CHECK(holds(refusal(two + "[[places]]\nname = \"far\"\nat = [1e300, 0]\n"), "at"));
}

TEST_CASE("zones are the controller's, a place in a keep-out zone is refused") {
  const std::string zoned = kGood + "[[zones]]\nkind = \"keep_out\"\npoints = [[3, 0], [5, 0], [5, 3], [3, 3]]\n";
  REQUIRE(load(zoned).setup.zones.size() == 1);
  CHECK(load(zoned).setup.zones[0].corners[2] == Vec2{5.0, 3.0});
  CHECK(refusal(zoned + "[[places]]\nname = \"kitchen\"\nat = [4.0, 1.5]\n")
            .starts_with("20: the goal lies in a keep-out"));
}

TEST_CASE("a robot file says how the devices are wired") {
  const RobotFile robot = load(kGood);
  CHECK(robot.setup.wired);
  CHECK(robot.setup.start == Pose2{1.0, 2.0, 0.5});
  CHECK(robot.setup.model.limits.max_speed_mps == 0.5);
  CHECK(robot.setup.model.laser.range_max_m == 10.0);
  CHECK(robot.laser.host == "10.0.0.2");
  CHECK(robot.laser.port == 2112);
  CHECK(robot.drive.can == "can0");
  CHECK(robot.drive.cia402.axes[0].node == 2);
  CHECK(robot.drive.cia402.axes[1].node == 3);
  // 76600 counts a turn are 12191.27 a radian.
  CHECK(robot.drive.cia402.axes[0].per_rad == Approx(12191.27));
  CHECK(robot.drive.cia402.axes[1].per_rad == Approx(-12191.27));
  CHECK(robot.drive.cia402.settings.controller_timeout_ms == 100);
  CHECK_FALSE(robot.drive.cia402.allow_unproved);
  CHECK(robot.goal_heading_tolerance_rad == 0.1);
  CHECK(load(with("start =", "goal_heading_tolerance_rad = 0.25\nstart =")).goal_heading_tolerance_rad == 0.25);
  CHECK(refusal(with("start =", "goal_heading_tolerance_rad = 5\nstart ="))
            .starts_with("2: goal_heading_tolerance_rad is 5; "));
}

TEST_CASE("drives brake at least as hard as the stop zone reckons") {
  const RobotFile robot = load(kGood);
  // One and a half times the model's 1 m/s2, over a wheel of 0.0975 m: 15.3846 rad/s2 of 12191.27 counts.
  REQUIRE(robot.setup.model.limits.brake_mps2 == 1.0);
  CHECK(robot.drive.cia402.settings.quick_stop == 187558);
  CHECK(robot.drive.cia402.settings.deceleration == 187558);
  // 1 m/s2 and 0.05 m/s at a wheel of 0.0975 m; 50 Hz.
  CHECK(robot.drive.cia402.stop.brake_radps2 == Approx(10.2564));
  CHECK(robot.drive.cia402.stop.tolerance_radps == Approx(0.51282));
  CHECK(robot.drive.cia402.stop.response == std::chrono::milliseconds(60));
  CHECK(robot.drive.cia402.stop.fresh == std::chrono::milliseconds(60));
  const StopLimits slow = load("rate_hz = 20.0\n" + kGood).drive.cia402.stop;
  CHECK(slow.response == std::chrono::milliseconds(120));
  CHECK(slow.fresh == std::chrono::milliseconds(125));
}

TEST_CASE("every kind of scanner and drive has its own keys") {
  const RobotFile serial = load(with("\"sick-cola-b\"\nhost = \"10.0.0.2\"", "\"ld19\"\ndevice = \"/dev/ttyUSB0\""));
  CHECK(serial.laser.kind == ScannerKind::kLdrobot);
  CHECK(serial.laser.host.empty());
  CHECK(serial.laser.device == "/dev/ttyUSB0");
  CHECK(serial.laser.baud == 230400);
  CHECK(load(with("sick-cola-b", "hokuyo")).laser.port == 10940);
  const RobotFile odrives = load(motors("odrive", "motor_turns_per_wheel_turn = 6.283185307179586"));
  CHECK(odrives.drive.kind == DriveKind::kOdrive);
  CHECK(odrives.drive.odrive.axes[0].per_rad == Approx(1.0));
  CHECK(odrives.drive.odrive.axes[1].per_rad == Approx(-1.0));
  // The p3dx brakes with 1 m/s2 on wheels of 0.0975 m; 50 Hz.
  const double radius_m = odrives.setup.model.drive.wheel_radius_m;
  CHECK(odrives.drive.odrive.stop.brake_radps2 == Approx(odrives.setup.model.limits.brake_mps2 / radius_m));
  CHECK(odrives.drive.odrive.stop.tolerance_radps == Approx(0.05 / radius_m));
  CHECK(odrives.drive.odrive.stop.fresh == std::chrono::milliseconds(60));
  const RobotFile vescs = load(motors("vesc", "electrical_turns_per_wheel_turn = 6.283185307179586"));
  CHECK(vescs.drive.kind == DriveKind::kVesc);
  CHECK(vescs.drive.vesc.axes[1].per_rad == Approx(-1.0));
  CHECK(refusal(with("cia402", "odrive")).starts_with("10: drive.motor_turns_per_wheel_turn is missing; "));
}

TEST_CASE(
    "host beside device, another kind's key, a capital letter, a scenario and a comma are each told as what they are") {
  CHECK(refusal(with("host = \"10.0.0.2\"", "host = \"10.0.0.2\"\ndevice = \"/dev/ttyUSB0\"")) ==
        "8: laser.device stands beside host; keep the one by which this scanner is connected");
  CHECK(refusal(kGood + "motor_turns_per_wheel_turn = 5\n") ==
        "15: drive.motor_turns_per_wheel_turn is not a known key of this kind, but of \"odrive\"; remove it, or choose "
        "that one");
  CHECK(refusal(with("[laser]", "[Laser]")) == "5: Laser is not a known key; did you mean laser?");
  CHECK(refusal("name = \"crossing\"\n[robot]\nmodel = \"p3dx\"\n") ==
        "2: robot is of a scenario: this is no robot file; run it by jaywalk sim");
  CHECK(refusal(with("max_speed_mps = 0.5", "max_speed_mps = 0,5")) == "3: a number with a comma; write 0.5");
}

// Of the p3dx: 1.5 times 1.0 m/s2; over half a track of 0.165 m 520.9 degrees/s2; 1.5 rad/s are 85.9 degrees/s.
TEST_CASE("a Pioneer is found by its line or address and told its model's ramps, which its own wheels scale") {
  const auto pioneer = [](const std::string& keys) { return drive_of("pioneer", "ticks_per_mm = 128\n" + keys); };
  const std::string line = "device = \"/dev/ttyUSB0\"\n";
  const RobotFile robot = load(pioneer(line + "left_wheel_radius_m = 0.1\nallow_unproved = true"));
  CHECK(robot.drive.kind == DriveKind::kPioneer);
  CHECK(robot.drive.can == "/dev/ttyUSB0");
  CHECK(robot.drive.line.baud == 9600);
  CHECK(robot.drive.arcos.ticks_per_mm == 128);
  CHECK(robot.drive.arcos.mm_per_rad[0] == Approx(95.0625));
  CHECK(robot.drive.arcos.mm_per_rad[1] == Approx(97.5));
  CHECK(robot.drive.arcos.motion.ramp_mmps2 == 1500);
  CHECK(robot.drive.arcos.motion.turn_ramp_dps2 == 521);
  CHECK(robot.drive.arcos.motion.top_mmps == 500);
  CHECK(robot.drive.arcos.motion.turn_top_dps == 86);
  CHECK(robot.drive.arcos.allow_unproved);
  CHECK(robot.setup.model.drive.times.report_s == Approx(0.1));
  CHECK(load(pioneer("host = \"10.0.0.3\"")).drive.can == "10.0.0.3:8101");
  CHECK(holds(refusal(pioneer(line + "host = \"h\"")),
              "drive.device stands beside host; keep the one by which this base"));
  CHECK(holds(refusal(pioneer(line + "baud = 4800")), "baud"));
  CHECK(holds(refusal(pioneer(line + "right_reversed = true")), "right_reversed"));
  CHECK(refusal("rate_hz = 20.0\n" + pioneer(line)) == "loaded");
}

TEST_CASE("a robot on ROS 2 is named by its topics, which stand for the bus") {
  const auto ros = [](const std::string& keys) { return drive_of("dds", keys); };
  const RobotFile robot = load(ros("command = \"/base/cmd_vel\"\nstamped = true"));
  CHECK(robot.drive.kind == DriveKind::kDds);
  CHECK(robot.drive.can == "/base/cmd_vel");
  CHECK(robot.drive.ros.odometry == "/odom");
  CHECK(robot.drive.ros.stamped);
  CHECK_FALSE(robot.drive.ros.allow_unproved);
  CHECK(robot.drive.ros.stop.brake_radps2 == Approx(10.2564));
  CHECK(robot.drive.wheel_radii_m[0] == robot.setup.model.drive.wheel_radius_m);
  CHECK(load(ros("")).drive.ros.command == "/cmd_vel");
  CHECK(load(ros("")).setup.model.drive.times.report_s == Approx(0.02));  // the loop's period
  const RobotFile slow = load(ros("report_ms = 100\nreport_late_ms = 60\nresponse_ms = 120"));
  CHECK(slow.setup.model.drive.times.report_s == Approx(0.1));
  CHECK(slow.drive.ros.times.late_s == Approx(0.06));
  CHECK(slow.drive.ros.stop.fresh == std::chrono::milliseconds(260));
  CHECK(setup_from_text(to_text(slow.setup), "here").model.drive.times.response_s == Approx(0.12));
  CHECK(holds(refusal(ros("report_ms = 400")), "report_ms"));
  for (const char* topic : {"cmd_vel", "/", "/cmd_vel/", "/a//b", "/../etc", "/cmd vel", ""})
    CHECK(holds(refusal(ros("command = \"" + std::string(topic) + "\"")), "is no topic's whole name"));
  CHECK(refusal(ros("can = \"can0\"")) != "loaded");
  CHECK(refusal(ros("left_reversed = true")) != "loaded");
  const RobotFile laser = load(with("\"sick-cola-b\"\nhost = \"10.0.0.2\"", "\"dds\"\ntopic = \"/front/scan\""));
  CHECK(laser.laser.kind == ScannerKind::kDds);
  CHECK(laser.laser.topic == "/front/scan");
  CHECK_FALSE(laser.laser.infinity_is_free);
  CHECK(holds(refusal(with("sick-cola-b", "dds")), "host"));
  CHECK(holds(refusal(with("host = \"10.0.0.2\"", "host = \"10.0.0.2\"\ntopic = \"/scan\"")), "topic"));
}

TEST_CASE("every drive's timeout outlasts two of the loop's periods") {
  const auto at = [](const std::string& rate_hz, const std::string& timeout_ms) {
    return "rate_hz = " + rate_hz + "\n" + more_of_drive("controller_timeout_ms = " + timeout_ms);
  };
  CHECK(refusal(at("20", "40"))
            .starts_with("14: drive.controller_timeout_ms is 40, less than two of the loop's periods; "));
  CHECK(refusal(at("20", "99")) != "loaded");
  CHECK(refusal(at("20", "100")) == "loaded");
  CHECK(refusal(at("50", "40")) == "loaded");
  const std::string vescs = motors("vesc", "electrical_turns_per_wheel_turn = 20"),
                    odrives = motors("odrive", "motor_turns_per_wheel_turn = 20");
  CHECK(load("rate_hz = 25\n" + vescs).drive.vesc.timeout_least == std::chrono::milliseconds(80));
  CHECK(refusal("rate_hz = 20\n" + vescs) != "loaded");
  CHECK(load("rate_hz = 20\n" + odrives).drive.odrive.watchdog_least == std::chrono::milliseconds(100));
}

TEST_CASE("a robot that outruns its stop zone is refused") {
  CHECK(refusal(with("range_m = 10.0", "range_m = 1.0")) != "loaded");
  CHECK(refusal(with("range_m = 10.0", "beams = 90")) != "loaded");
}

TEST_CASE("a joystick is read from the file with its buttons") {
  CHECK_FALSE(load(kGood).panel);
  const std::string panel =
      "\n[panel]\njoystick = \"/dev/input/by-id/pad\"\nneeds_dead_man = false\nstop_button = 0x130\nstop_opens = "
      "true\n";
  const RobotFile robot = load(kGood + panel);
  REQUIRE(robot.panel);
  CHECK(robot.panel->path == "/dev/input/by-id/pad");
  CHECK_FALSE(robot.panel->needs_dead_man);
  CHECK(robot.panel->stop == 0x130);
  CHECK(robot.panel->stop_opens);
  CHECK(robot.panel->dead_man == 0x136);  // BTN_TL
  CHECK(holds(refusal(kGood + "\n[panel]\nneeds_dead_man = true\n"), "joystick"));
  CHECK(robot.panel->dead_man_renew == Duration{0});
  CHECK(load(kGood + "\n[panel]\njoystick = \"/dev/null\"\ndead_man_renew_s = 1.5\n").panel->dead_man_renew ==
        std::chrono::milliseconds(1500));
  CHECK(holds(refusal(kGood + panel + "dead_man_renew_s = 2\n"), "has no dead man to renew"));
  CHECK(holds(refusal(kGood + panel + "throttle = 1\n"), "throttle"));
}

TEST_CASE("a stick is for nothing unless the file says so, and drives only with a dead man") {
  const std::string panel = kGood + "\n[panel]\njoystick = \"/dev/null\"\n";
  CHECK(load(panel).setup.steering == StickUse::kNone);
  CHECK(load(panel + "steering = \"shared\"\n").setup.steering == StickUse::kShared);
  CHECK(load(panel + "steering = \"by_hand\"\n").setup.steering == StickUse::kByHand);
  CHECK(holds(refusal(panel + "steering = \"shared\"\nneeds_dead_man = false\n"), "panel.steering has no dead man"));
}

TEST_CASE("two drives, or two buttons, are not one") {
  CHECK(holds(refusal(more_of_drive("left_node = 3")), "drive.right_node is left_node too; "));
  CHECK(refusal(more_of_drive("controller_node = 2")).starts_with("13: drive.controller_node is left_node too; "));
  CHECK(load(more_of_drive("left_node = 3\nright_node = 2")).drive.cia402.axes[1].node == 2);
  const std::string panel = kGood + "\n[panel]\njoystick = \"/dev/null\"\nstop_button = 0x136\n";
  CHECK(holds(refusal(panel), "panel.stop_button is dead_man_button too; "));
}

TEST_CASE("what is wrong in a robot file is refused with its line") {
  CHECK(refusal(kGood) == "loaded");
  CHECK(refusal(with("start =", "begin =")).starts_with("2: begin is not a known key; "));
  CHECK(refusal(with("host = ", "hots = ")) == "7: laser.hots is not a known key; did you mean host?");
  CHECK(refusal(with("right_reversed", "right_revresed")).starts_with("14: drive.right_revresed is not a known key; "));
  CHECK(refusal(with("sick-cola-b", "sonar")).starts_with("6: laser.kind is \"sonar\"; "));
  CHECK(refusal(with("cia402", "steam")).starts_with("11: drive.kind is \"steam\"; "));
  CHECK(refusal(with("max_speed_mps = 0.5", "max_speed_mps = 50")).starts_with("3: max_speed_mps is 50; "));
  CHECK(refusal(with("76600", "0")).starts_with("13: drive.counts_per_wheel_turn is 0; "));
  CHECK(
      refusal(more_of_drive("controller_timeout_ms = 1000")).starts_with("13: drive.controller_timeout_ms is 1000; "));
}

TEST_CASE("wheels, track and gear that no such robot has are refused") {
  const auto both = [&](const std::string& radius) {
    return more_of_drive("left_wheel_radius_m = " + radius + "\nright_wheel_radius_m = " + radius);
  };
  CHECK(refusal(both("0.01")).starts_with("13: drive.left_wheel_radius_m is 0.01; "));
  CHECK(holds(refusal(both("0.3")), "drive.left/right_wheel_radius_m: is 0.3 m, and the model's wheels have 0.0975 m"));
  CHECK(refusal(both("0.1")) == "loaded");
  CHECK(holds(refusal(more_of_drive("left_wheel_radius_m = 0.115")), "the right one's 0.0975 m"));
  CHECK(holds(refusal(more_of_drive("track_width_m = 0.6")), "drive.track_width_m: is 0.6 m, and the model's 0.33 m"));
  CHECK(refusal(with("76600", "1")).starts_with("13: drive.counts_per_wheel_turn is 1; "));
  // 0.5 m/s are 5.13 rad/s: 100 counts a turn are 82 a second, 1.6 in a tick of 50 Hz.
  CHECK(holds(refusal(with("76600", "100")), "drive.counts_per_wheel_turn: 100 counts a turn are 1.6 in a tick"));
  CHECK(refusal(with("76600", "200")) == "loaded");
  CHECK(holds(refusal(motors("odrive", "motor_turns_per_wheel_turn = 900")), "times a minute"));
  CHECK(holds(refusal(motors("vesc", "electrical_turns_per_wheel_turn = 9000")), "times a minute"));
  CHECK(refusal(motors("vesc", "electrical_turns_per_wheel_turn = 15")) == "loaded");
}

TEST_CASE("a model whose wheels cannot do what it promises is refused") {
  const auto of_model = [](const std::string& radius, const std::string& turns) {
    const Scratch folder;
    const std::string model = folder.write(
        "model.toml", "[footprint]\nfront_m = 0.3\nrear_m = 0.3\nhalf_width_m = 0.25\n[drive]\nwheel_radius_m = " +
                          radius + "\ntrack_width_m = 0.42\nmax_wheel_speed_radps = " + turns +
                          "\n[limits]\nmax_speed_mps = 0.6\nmax_turn_radps = 1.2\nmax_accel_mps2 = 0.4\n"
                          "max_turn_accel_radps2 = 2.5\nmax_jerk_mps3 = 1.5\nbrake_mps2 = 0.9\n[laser]\n"
                          "mount = [0.2, 0, 0]\nfov_deg = 270\nbeams = 811\nrate_hz = 15\nrange_min_m = 0.05\n"
                          "range_m = 25\n");
    return refusal(with("\"p3dx\"", "\"" + model + "\""));
  };
  CHECK(of_model("0.1", "12") == "loaded");
  CHECK(holds(of_model("0.1", "4"), "model: drive.max_wheel_speed_radps: times the wheel's radius"));
  CHECK(holds(of_model("0.02", "12"), "model: drive.max_wheel_speed_radps: times the wheel's radius"));
  CHECK(holds(of_model("0.35", "12"), "is longer than the body"));
  CHECK(of_model("0.01", "12") != "loaded");
}
