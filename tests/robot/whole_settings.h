#pragma once
// Settings files in which every key of the tables stands at least once.
#include <array>
#include <string>
#include <vector>

namespace jaywalk {

inline std::string whole_laser(const std::string& section = "laser") {
  return R"(mount = [0.1, 0.0, 0.0]
fov_deg = 270.0
beams = 811
rate_hz = 15.0
range_min_m = 0.05
range_m = 25.0
noise_m = 0.01
drop_out = 0.0
[[)" + section +
         ".blanked]]\nfrom_deg = 95.0\nto_deg = 110.0\n";
}

inline const std::string kWholeZones = R"([[zones]]
kind = "keep_out"
points = [[-3.0, 5.0], [-2.0, 5.0], [-2.0, 6.5]]
[[zones]]
kind = "speed"
points = [[1.0, 5.0], [2.0, 5.0], [2.0, 6.5]]
speed_mps = 0.2
)";

inline const std::string kWholeModel = R"(name = "whole"
[footprint]
front_m = 0.3
rear_m = 0.2
half_width_m = 0.25
[drive]
wheel_radius_m = 0.1
track_width_m = 0.4
max_wheel_speed_radps = 10.0
[limits]
max_speed_mps = 0.5
max_turn_radps = 1.2
max_accel_mps2 = 0.4
max_turn_accel_radps2 = 2.0
max_jerk_mps3 = 1.5
brake_mps2 = 0.9
[laser]
)" + whole_laser();

inline const std::string kTwoNodes = "\ncan = \"can0\"\nleft_node = 1\nright_node = 2\n";

/// Kinds in quotes, and the keys that go with them.
inline std::string robot_of(const std::string& model, const std::string& laser, const std::string& drive) {
  return "model = \"" + model + "\"\n[laser]\nkind = " + laser + "\n[drive]\nkind = " + drive + "\n";
}

inline const std::array<std::string, 6> kWholeRobots{
    R"(model = "p3dx"
max_speed_mps = 0.5
comfort = "gentle"
start = [0.0, 0.0, 0.0]
goal_tolerance_m = 0.3
goal_heading_tolerance_rad = 0.1
rate_hz = 50.0
control_socket = "control"
[laser]
kind = "sick-cola-b"
host = "192.168.0.1"
port = 2112
first_scan_limit_s = 10.0
)" + whole_laser() +
        R"([drive]
kind = "cia402"
can = "can0"
left_node = 2
right_node = 3
controller_node = 1
counts_per_wheel_turn = 76600
left_reversed = false
right_reversed = true
left_wheel_radius_m = 0.0981
right_wheel_radius_m = 0.0974
track_width_m = 0.332
controller_timeout_ms = 100
heartbeat_ms = 50
allow_unproved = false
[panel]
joystick = "/dev/input/event0"
needs_dead_man = true
dead_man_renew_s = 2.0
steering = "shared"
dead_man_button = 0x136
stop_button = 0x131
stop_opens = false
reset_button = 0x13B
[[places]]
name = "kitchen"
at = [4.0, 1.5, 1.57]
[realtime]
priority = 80
lock_memory = true
cpu = 3
required = true
[map]
yaml = "hall.yaml"
)" + kWholeZones,
    robot_of("p3dx", "\"lms200\"\ndevice = \"/dev/ttyUSB1\"",
             "\"pioneer\"\ndevice = \"/dev/ttyUSB0\"\nbaud = 115200\nticks_per_mm = 128\nreport_ms = 100.0\n"
             "report_late_ms = 20.0"),
    robot_of("p3dx", "\"lms200\"\ndevice = \"/dev/ttyUSB1\"",
             "\"pioneer\"\nhost = \"192.168.0.1\"\nport = 8101\nticks_per_mm = 128"),
    robot_of("wheelchair", "\"ld19\"\ndevice = \"/dev/ttyUSB0\"\nbaud = 230400",
             "\"odrive\"" + kTwoNodes + "motor_turns_per_wheel_turn = 8.0"),
    robot_of("p3dx", "\"hokuyo\"\nhost = \"192.168.0.10\"",
             "\"vesc\"" + kTwoNodes + "electrical_turns_per_wheel_turn = 160.0"),
    robot_of("p3dx", "\"dds\"\ntopic = \"/front/scan\"\nreliable = false\ninfinity_is_free = true",
             "\"dds\"\nodometry = \"/odom\"\ncommand = \"/cmd_vel\"\nstamped = true\nreliable = false\n"
             "report_ms = 100.0\nreport_late_ms = 60.0\nresponse_ms = 120.0\nallow_unproved = true")};

/// A whole line of [map], and lines that say a kind of stick, stand in the places of MAP and STICK.
inline const std::string kWholeScenario = R"(name = "whole"
seed = 7
timeout_s = 20.0
[map]
MAP
[robot]
start = [-3.0, 0.0, 0.0]
goal = [3.0, 0.0, 1.0]
goal_tolerance_m = 0.3
goal_heading_tolerance_rad = 0.1
model = "p3dx"
max_speed_mps = 0.6
comfort = "brisk"
[robot.laser]
turns = true
)" + whole_laser("robot.laser") + R"([robot.slip]
mean = 0.01
std = 0.005
[robot.reports]
period_ms = 100.0
late_ms = 60.0
[robot.truth]
left_wheel_radius_m = 0.098
right_wheel_radius_m = 0.097
track_width_m = 0.335
laser_mount = [0.11, 0.01, 0.02]
[robot.pose_source]
enabled = true
rate_hz = 5.0
position_std_m = 0.03
heading_std_rad = 0.01
mover_std_m = 0.05
gives_movers = true
[stick]
STICK
steering = "by_hand"
noise_std = 0.1
delay_s = 0.3
[[movers]]
kind = "wander"
count = 2
speed_mps = 0.4
radius_m = 0.27
turn_rate_radps = 1.0
spontaneous_turns_hz = 0.1
legs = false
[[movers]]
kind = "social"
count = 2
speed_mps = 1.3
radius_m = 0.25
group = 2
reaction = "curious"
legs = true
[[movers]]
kind = "recorded"
file = "rows.csv"
radius_m = 0.25
offset = [0.0, 0.0]
start_at_s = 1.0
loop = true
legs = true
[[faults]]
kind = "beams_lost"
at_s = 5.0
for_s = 1.0
scanner = 1
from_deg = -20.0
claims_free = true
to_deg = 20.0
[[faults]]
kind = "carried"
at_s = 7.0
for_s = 2.0
way = [1.0, 0.5, 0.2]
)" + kWholeZones;

inline std::string whole_scenario(const std::string& map, const std::string& stick) {
  std::string text = kWholeScenario;
  text.replace(text.find("MAP"), 3, map);
  return text.replace(text.find("STICK"), 5, stick);
}

inline std::vector<std::string> whole_scenarios() {
  return {whole_scenario("yaml = \"posts.txt\"\nknown = true", "kind = \"straight\"\nforward = 0.9"),
          whole_scenario("aria = \"posts.txt\"", "kind = \"to_goal\"\nforward = 0.9"),
          whole_scenario("cylinders = \"posts.txt\"", "kind = \"table\"\nfile = \"stick.csv\"")};
}

}  // namespace jaywalk
