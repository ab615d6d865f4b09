#pragma once
// Settings files in which every key of the tables stands at least once.
#include <array>
#include <string>

namespace jaywalk {

inline const std::string kWholeLaser = R"(mount = [0.1, 0.0, 0.0]
fov_deg = 270.0
beams = 811
rate_hz = 15.0
range_min_m = 0.05
range_m = 25.0
noise_m = 0.01
drop_out = 0.0
[[laser.blanked]]
from_deg = 95.0
to_deg = 110.0
)";

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
)" + kWholeLaser;

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
)" + kWholeLaser +
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
    R"(model = "p3dx"
[laser]
kind = "lms200"
device = "/dev/ttyUSB1"
[drive]
kind = "pioneer"
device = "/dev/ttyUSB0"
baud = 115200
ticks_per_mm = 128
report_ms = 100.0
report_late_ms = 20.0
)",
    R"(model = "p3dx"
[laser]
kind = "lms200"
device = "/dev/ttyUSB1"
[drive]
kind = "pioneer"
host = "192.168.0.1"
port = 8101
ticks_per_mm = 128
)",
    R"(model = "wheelchair"
[laser]
kind = "ld19"
device = "/dev/ttyUSB0"
baud = 230400
[drive]
kind = "odrive"
can = "can0"
left_node = 1
right_node = 2
motor_turns_per_wheel_turn = 8.0
)",
    R"(model = "p3dx"
[laser]
kind = "hokuyo"
host = "192.168.0.10"
[drive]
kind = "vesc"
can = "can0"
left_node = 1
right_node = 2
electrical_turns_per_wheel_turn = 160.0
)",
    R"(model = "p3dx"
[laser]
kind = "dds"
topic = "/front/scan"
reliable = false
infinity_is_free = true
[drive]
kind = "dds"
odometry = "/odom"
command = "/cmd_vel"
stamped = true
reliable = false
report_ms = 100.0
report_late_ms = 60.0
response_ms = 120.0
allow_unproved = true
)"};

/// MAP is to be replaced by a whole [map] line, STICK by lines that say a kind of stick, ROWS by a file of recorded
/// movers.
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
fov_deg = 180.0
beams = 181
rate_hz = 10.0
range_min_m = 0.05
range_m = 20.0
noise_m = 0.01
drop_out = 0.01
mount = [0.1, 0.0, 0.0]
[[robot.laser.blanked]]
from_deg = 70.0
to_deg = 80.0
[robot.slip]
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
file = "ROWS"
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

}  // namespace jaywalk
