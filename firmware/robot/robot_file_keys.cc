#include "firmware/robot/robot_file_keys.h"

#include "firmware/robot/drive_wiring.h"
#include "firmware/robot/robot_file.h"
#include "hal/map_zones_file.h"
#include "hal/robot_model_file.h"

namespace jaywalk {
namespace {

using enum KeyKind;

constexpr Range kButtons{0.0, 767.0};  // KEY_MAX of linux/input-event-codes.h

std::vector<SettingKey> top_keys() {
  const RobotFile robot;
  return {{"", "model", kText, {}, "", kNeeded, "\"p3dx\", \"wheelchair\", or a robot model file"},
          {"", "max_speed_mps", kNumber, {0.05, 10.0}, "m/s", "the model's", "cruising speed; at most the model's"},
          comfort_key(""),
          {"",
           "start",
           kNumbers,
           {},
           "m, m, rad",
           "[0, 0, 0]",
           "[x, y, heading] in the map when the program starts; with [map] and without it: found by the first scan"},
          {"",
           "goal_tolerance_m",
           kNumber,
           {0.05, 5.0},
           "m",
           robot.setup.goal_tolerance_m,
           "a goal counts as reached within this"},
          {"",
           "goal_heading_tolerance_rad",
           kNumber,
           {0.02, kPi},
           "rad",
           robot.goal_heading_tolerance_rad,
           "and within this of its heading, where one is wanted"},
          {"", "map", kTable, {}, "", "none", "what is known before the first scan"},
          {"map", "yaml", kFile, {}, "", kNeeded, "ROS map_server file"},
          {"", "rate_hz", kNumber, {20.0, 200.0}, "1/s", robot.setup.rate_hz, "of the control loop"},
          {"", "control_socket", kText, {}, "", "the usual one", "where goto, stop, reset and status reach the run"},
          {"", "laser", kTable, {}, "", kNeeded, "the scanner, or [[laser]] for each"},
          {"", "drive", kTable, {}, "", kNeeded, "the motor controllers"},
          {"", "panel", kTable, {}, "", "none", "a joystick or a box of buttons behind evdev"},
          {"", "places", kTables, {}, "", "none", "where jaywalk goto NAME leads"},
          {"", "realtime", kTable, {}, "", "the defaults", "what the loop asks of the kernel"}};
}

std::vector<SettingKey> scanner_keys() {
  std::vector<std::string> kinds;
  for (const ScannerMake& make : scanner_makes()) kinds.emplace_back(make.name);
  return {{"laser", "kind", kChoice, {}, "", kNeeded, "what the scanner speaks", kinds},
          {"laser", "host", kText, {}, "", kNeeded, "address, of one on the network"},
          {"laser:dds", "topic", kText, {}, "", "/scan", "its sensor_msgs/LaserScan, by jaywalk_dds"},
          {"laser:dds", "reliable", kBoolean, {}, "", LaserWiring{}.reliable, "lost scans are sent again"},
          {"laser:dds",
           "infinity_is_free",
           kBoolean,
           {},
           "",
           LaserWiring{}.infinity_is_free,
           "infinity is free room (REP 117); rplidar_ros means errors, too"},
          {"laser", "port", kInteger, {1.0, 65535.0}, "", "the maker's", "TCP port, of one on the network"},
          {"laser", "device", kText, {}, "", kNeeded, "\"/dev/ttyUSB0\" say, of one on a serial line"},
          {"laser", "baud", kInteger, {1200.0, 4000000.0}, "bit/s", "the maker's", "of one on a serial line"},
          {"laser",
           "first_scan_limit_s",
           kNumber,
           {0.1, 600.0},
           "s",
           to_seconds(LaserWiring{}.first_scan_limit),
           "how long to wait for it at start"}};
}

std::vector<SettingKey> panel_keys() {
  const PanelWiring panel;
  const panel::JoystickSetup& joystick = panel.joystick;
  return {{"panel", "joystick", kText, {}, "", kNeeded, "the evdev device; gone, or not there: emergency stop"},
          {"panel",
           "needs_dead_man",
           kBoolean,
           {},
           "",
           panel.needs_dead_man,
           "the robot drives only while its button is held"},
          {"panel",
           "dead_man_renew_s",
           kNumber,
           {0.0, 60.0},
           "s",
           to_seconds(joystick.dead_man_renew),
           "so long after the newest event the dead man counts as released; 0: never; needed on Bluetooth"},
          {"panel",
           "steering",
           kChoice,
           {},
           "",
           "none",
           "what the stick is for; shared: the robot steers clear and stops; by_hand: the supervisor alone stops it",
           {"none", "shared", "by_hand"}},
          {"panel", "dead_man_button", kInteger, kButtons, "", static_cast<double>(joystick.dead_man),
           "number of linux/input-event-codes.h: the left shoulder"},
          {"panel", "stop_button", kInteger, kButtons, "", static_cast<double>(joystick.stop), "emergency stop"},
          {"panel",
           "stop_opens",
           kBoolean,
           {},
           "",
           joystick.stop_opens,
           "the stop is a contact that opens; not known means stop"},
          {"panel", "reset_button", kInteger, kButtons, "", static_cast<double>(joystick.reset), "reset, at rest"}};
}

std::vector<SettingKey> place_keys() {
  return {{"places", "name", kText, {}, "", kNeeded, "begins with a letter; letters, digits, _ and -"},
          {"places", "at", kNumbers, {}, "m, m, rad", kNeeded, "[x, y] or [x, y, heading] in the map"}};
}

std::vector<SettingKey> realtime_keys() {
  const RealtimeWishes wishes;
  return {
      {"realtime",
       "priority",
       kInteger,
       {0.0, 98.0},
       "",
       static_cast<double>(wishes.priority),
       "of SCHED_FIFO, for the loop; 0: an ordinary thread"},
      {"realtime", "lock_memory", kBoolean, {}, "", wishes.lock_memory, "nothing of the program is paged out"},
      {"realtime",
       "required",
       kBoolean,
       {},
       "",
       wishes.required,
       "false: a run starts although the kernel refuses some of this"},
      {"realtime", "cpu", kInteger, {0.0, 1023.0}, "", "any", "a processor for the loop alone (boot with isolcpus)"}};
}

FileKeys make_robot_file_keys() {
  FileKeys file{"Robot file", {}};
  for (const auto& keys : {top_keys(), scanner_keys(), laser_keys("laser"), drive_keys(), panel_keys(), place_keys(),
                           zone_keys(), realtime_keys()})
    file.keys.insert(file.keys.end(), keys.begin(), keys.end());
  return file;
}

using enum KeyKind;

constexpr Range kNodes{1.0, 127.0};  // CANopen's; ODrive and VESC take no other here

/// What a motor controller of `kind` needs that is one a wheel.
void add_axes(std::vector<SettingKey>& keys, const std::string& kind, double left_node, const char* scale,
              const char* meaning, Range per_turn) {
  keys.push_back({"drive:" + kind, scale, kNumber, per_turn, "", kNeeded, meaning});
  keys.push_back({"drive:" + kind, "left_node", kInteger, kNodes, "", left_node, "the left drive's number on the bus"});
  keys.push_back({"drive:" + kind, "right_node", kInteger, kNodes, "", left_node + 1.0, "the right drive's"});
}

/// Of a base that reports at its own rate.
void add_reports(std::vector<SettingKey>& keys, const std::string& kind, const Otherwise& period) {
  keys.push_back({"drive:" + kind, "report_ms", kNumber, {1.0, 250.0}, "ms", period, "between two of its reports"});
  keys.push_back({"drive:" + kind,
                  "report_late_ms",
                  kNumber,
                  {0.0, 200.0},
                  "ms",
                  1e3 * DriveTimes{}.late_s,
                  "so much later than its turn a report may come"});
}

}  // namespace

const FileKeys& robot_file_keys() {
  static const FileKeys keys = make_robot_file_keys();
  return keys;
}

std::vector<SettingKey> drive_keys() {
  // The choices are in the order of DriveKind.
  std::vector<SettingKey> keys{
      {"drive",
       "kind",
       kChoice,
       {},
       "",
       kNeeded,
       "what the motor controllers speak",
       {"cia402", "odrive", "vesc", "dds", "pioneer"}},
      {"drive", "can", kText, {}, "", kNeeded, "the CAN interface, \"can0\" say"},
      {"drive", "left_reversed", kBoolean, {}, "", false, "the left motor looks the other way"},
      {"drive", "right_reversed", kBoolean, {}, "", false, "the right motor looks the other way"},
      {"drive", "left_wheel_radius_m", kNumber, {0.02, 0.5}, "m", "the model's", "as jaywalk calibrate measures it"},
      {"drive", "right_wheel_radius_m", kNumber, {0.02, 0.5}, "m", "the model's", "the same of the right wheel"},
      {"drive", "track_width_m", kNumber, {0.05, 3.0}, "m", "the model's", "between the wheels' contact points"},
      {"drive",
       "response_ms",
       kNumber,
       {1.0, 500.0},
       "ms",
       1e3 * DriveTimes{}.response_s,
       "from a command until the wheels turn so, ramps apart; jaywalk commission measures it"},
      {"drive",
       "allow_unproved",
       kBoolean,
       {},
       "",
       false,
       "arm although a drive did not prove that it stops by itself"}};
  add_axes(keys, "cia402", 2.0, "counts_per_wheel_turn", "encoder counts a turn of the wheel, gear included",
           {12.0, 1e8});
  add_axes(keys, "odrive", 1.0, "motor_turns_per_wheel_turn", "the gear", {0.1, 1000.0});
  add_axes(keys, "vesc", 1.0, "electrical_turns_per_wheel_turn", "gear times pole pairs", {1.0, 1e5});
  keys.push_back({"drive:cia402", "controller_node", kInteger, kNodes, "", 1.0,
                  "the node whose heartbeat the drives watch: this program"});
  keys.push_back({"drive:cia402",
                  "controller_timeout_ms",
                  kInteger,
                  {40.0, 100.0},
                  "ms",
                  100.0,
                  "without that heartbeat a drive stops by itself; at least two of the loop's periods"});
  keys.push_back({"drive:cia402",
                  "heartbeat_ms",
                  kInteger,
                  {5.0, 100.0},
                  "ms",
                  50.0,
                  "the drives' own heartbeat; missed for three of these, a drive counts as lost"});
  const ros::BaseSetup base;
  keys.push_back({"drive:dds", "odometry", kText, {}, "", "/odom", "its nav_msgs/Odometry"});
  keys.push_back({"drive:dds", "command", kText, {}, "", "/cmd_vel", "where it takes commands"});
  add_reports(keys, "dds", "the loop's period");
  keys.push_back({"drive:dds", "stamped", kBoolean, {}, "", base.stamped, "as TwistStamped"});
  keys.push_back({"drive:dds", "reliable", kBoolean, {}, "", base.reliable, "lost odometry is sent again"});
  keys.push_back({"drive:pioneer", "device", kText, {}, "", kNeeded, "\"/dev/ttyUSB0\" say, of one on a serial line"});
  keys.push_back({"drive:pioneer", "baud", kInteger, {9600.0, 115200.0}, "bit/s", "the maker's", "its HostBaud"});
  keys.push_back({"drive:pioneer", "host", kText, {}, "", kNeeded, "address, of one on the network"});
  keys.push_back({"drive:pioneer", "port", kInteger, {1.0, 65535.0}, "", "the maker's", "TCP port: 8101"});
  keys.push_back({"drive:pioneer",
                  "ticks_per_mm",
                  kInteger,
                  {1.0, 65535.0},
                  "",
                  kNeeded,
                  "its TicksMM: encoder counts a millimetre, 128 of a P3-DX"});
  add_reports(keys, "pioneer", 100.0);
  return keys;
}

}  // namespace jaywalk
