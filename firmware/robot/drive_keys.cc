#include "firmware/robot/drive_wiring.h"
#include "firmware/robot/robot_file_keys.h"

namespace jaywalk {
namespace {

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
