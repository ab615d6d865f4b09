#include "firmware/robot/robot_file.h"

#include "firmware/recording/map_files.h"
#include "firmware/safety/stop_zone.h"
#include "hal/map_zones_file.h"
#include "hal/robot_model_file.h"

namespace jaywalk {
namespace {

using enum KeyKind;
using Rows = std::vector<SettingKey>;

constexpr Range kButtons{0.0, 767.0};  // KEY_MAX of linux/input-event-codes.h
constexpr Range kNodes{1.0, 127.0};    // CANopen's; ODrive and VESC take no other here
constexpr Range kPorts{1.0, 65535.0};
constexpr const char* kModels = "the model's";
constexpr const char* kMakers = "the maker's";
constexpr const char* kDevice = "\"/dev/ttyUSB0\" say, of one on a serial line";
constexpr const char* kHost = "address, of one on the network";

Rows top_keys() {
  const RobotFile robot;
  return {key_row("model", kText, kNeeded, "\"p3dx\", \"wheelchair\", or a robot model file"),
          number_row("max_speed_mps", {0.05, 10.0}, "m/s", kModels, "cruising speed; at most the model's"),
          comfort_key(),
          key_row("start", kNumbers, "[0, 0, 0]",
                  "[x, y, heading] in the map when the program starts; with [map] and without it: found by the first "
                  "scan",
                  "m, m, rad"),
          number_row("goal_tolerance_m", {0.05, 5.0}, "m", robot.setup.goal_tolerance_m,
                     "a goal counts as reached within this"),
          number_row("goal_heading_tolerance_rad", {0.02, kPi}, "rad", robot.goal_heading_tolerance_rad,
                     "and within this of its heading, where one is wanted"),
          key_row("map", kTable, "none", "what is known before the first scan"),
          in_section("map", key_row("yaml", kFile, kNeeded, "ROS map_server file")),
          number_row("rate_hz", {20.0, 200.0}, "1/s", robot.setup.rate_hz, "of the control loop"),
          key_row("control_socket", kText, "the usual one", "where goto, stop, reset and status reach the run"),
          key_row("laser", kTable, kNeeded, "the scanner, or [[laser]] for each"),
          key_row("drive", kTable, kNeeded, "the motor controllers"),
          key_row("panel", kTable, "none", "a joystick or a box of buttons behind evdev"),
          key_row("places", kTables, "none", "where jaywalk goto NAME leads"),
          key_row("realtime", kTable, "the defaults", "what the loop asks of the kernel")};
}

Rows first_scanner_keys() {
  std::vector<std::string> kinds;
  for (const ScannerMake& make : scanner_makes()) kinds.emplace_back(make.name);
  return section_keys(
      "laser", {choice_row("kind", kNeeded, "what the scanner speaks", kinds), key_row("host", kText, kNeeded, kHost)});
}

Rows other_scanner_keys() {
  return section_keys("laser",
                      {whole_row("port", kPorts, "", kMakers, "TCP port, of one on the network"),
                       key_row("device", kText, kNeeded, kDevice),
                       whole_row("baud", {1200.0, 4000000.0}, "bit/s", kMakers, "of one on a serial line"),
                       number_row("first_scan_limit_s", {0.1, 600.0}, "s", to_seconds(LaserWiring{}.first_scan_limit),
                                  "how long to wait for it at start")});
}

Rows drive_keys() {
  // The choices are in the order of DriveKind.
  return section_keys(
      "drive",
      {choice_row("kind", kNeeded, "what the motor controllers speak", {"cia402", "odrive", "vesc", "dds", "pioneer"}),
       key_row("can", kText, kNeeded, "the CAN interface, \"can0\" say"),
       key_row("left_reversed", kBoolean, false, "the left motor looks the other way"),
       key_row("right_reversed", kBoolean, false, "the right motor looks the other way"),
       number_row("left_wheel_radius_m", {0.02, 0.5}, "m", kModels, "as jaywalk calibrate measures it"),
       number_row("right_wheel_radius_m", {0.02, 0.5}, "m", kModels, "the same of the right wheel"),
       number_row("track_width_m", {0.05, 3.0}, "m", kModels, "between the wheels' contact points"),
       number_row("response_ms", {1.0, 500.0}, "ms", 1e3 * DriveTimes{}.response_s,
                  "from a command until the wheels turn so, ramps apart; jaywalk commission measures it"),
       key_row("allow_unproved", kBoolean, false, "arm although a drive did not prove that it stops by itself")});
}

/// Of two motor controllers of `kind`, one a wheel.
Rows axis_keys(const std::string& kind, double left_node, const char* scale, const char* meaning, Range per_turn) {
  return section_keys("drive:" + kind,
                      {number_row(scale, per_turn, "", kNeeded, meaning),
                       whole_row("left_node", kNodes, "", left_node, "the left drive's number on the bus"),
                       whole_row("right_node", kNodes, "", left_node + 1.0, "the right drive's")});
}

// Rows of a base that reports at its own rate.

SettingKey report_row(const Otherwise& period) {
  return number_row("report_ms", {1.0, 250.0}, "ms", period, "between two of its reports");
}

SettingKey late_row() {
  return number_row("report_late_ms", {0.0, 200.0}, "ms", 1e3 * DriveTimes{}.late_s,
                    "so much later than its turn a report may come");
}

Rows ros_keys() {
  const ros::BaseSetup base;
  return section_keys(
      "drive:dds", {key_row("odometry", kText, "/odom", "its nav_msgs/Odometry"),
                    key_row("command", kText, "/cmd_vel", "where it takes commands"), report_row("the loop's period"),
                    late_row(), key_row("stamped", kBoolean, base.stamped, "as TwistStamped"),
                    key_row("reliable", kBoolean, base.reliable, "lost odometry is sent again")});
}

Rows pioneer_keys() {
  return section_keys("drive:pioneer",
                      {key_row("device", kText, kNeeded, kDevice),
                       whole_row("baud", {9600.0, 115200.0}, "bit/s", kMakers, "its HostBaud"),
                       key_row("host", kText, kNeeded, kHost), whole_row("port", kPorts, "", kMakers, "TCP port: 8101"),
                       whole_row("ticks_per_mm", {1.0, 65535.0}, "", kNeeded,
                                 "its TicksMM: encoder counts a millimetre, 128 of a P3-DX"),
                       report_row(100.0), late_row()});
}

Rows place_keys() {
  return section_keys("places",
                      {key_row("name", kText, kNeeded, "begins with a letter; letters, digits, _ and -"),
                       key_row("at", kNumbers, kNeeded, "[x, y] or [x, y, heading] in the map", "m, m, rad")});
}

const BoundKeys<LaserWiring>& dds_laser_keys() {
  static const BoundKeys<LaserWiring> keys(
      "laser:dds", {key_row("topic", kText, "/scan", "its sensor_msgs/LaserScan, by jaywalk_dds"),
                    boolean_row("reliable", &LaserWiring::reliable, "lost scans are sent again"),
                    boolean_row("infinity_is_free", &LaserWiring::infinity_is_free,
                                "infinity is free room (REP 117); rplidar_ros means errors, too")});
  return keys;
}

const BoundKeys<panel::JoystickSetup>& panel_keys() {
  using panel::JoystickSetup;
  static const BoundKeys<JoystickSetup> keys(
      "panel",
      {key_row("joystick", kText, kNeeded, "the evdev device; gone, or not there: emergency stop"),
       boolean_row("needs_dead_man", &JoystickSetup::needs_dead_man, "the robot drives only while its button is held"),
       number_row("dead_man_renew_s", {0.0, 60.0}, "s", to_seconds(JoystickSetup{}.dead_man_renew),
                  "so long after the newest event the dead man counts as released; 0: never; needed on Bluetooth"),
       choice_row("steering", "none",
                  "what the stick is for; shared: the robot steers clear and stops; by_hand: the supervisor alone "
                  "stops it",
                  {"none", "shared", "by_hand"}),
       whole_row("dead_man_button", &JoystickSetup::dead_man, kButtons, "",
                 "number of linux/input-event-codes.h: the left shoulder"),
       whole_row("stop_button", &JoystickSetup::stop, kButtons, "", "emergency stop"),
       boolean_row("stop_opens", &JoystickSetup::stop_opens, "the stop is a contact that opens; not known means stop"),
       whole_row("reset_button", &JoystickSetup::reset, kButtons, "", "reset, at rest")});
  return keys;
}

const BoundKeys<RealtimeWishes>& realtime_keys() {
  static const BoundKeys<RealtimeWishes> keys(
      "realtime", {whole_row("priority", &RealtimeWishes::priority, {0.0, 98.0}, "",
                             "of SCHED_FIFO, for the loop; 0: an ordinary thread"),
                   boolean_row("lock_memory", &RealtimeWishes::lock_memory, "nothing of the program is paged out"),
                   boolean_row("required", &RealtimeWishes::required,
                               "false: a run starts although the kernel refuses some of this"),
                   whole_row("cpu", {0.0, 1023.0}, "", "any", "a processor for the loop alone (boot with isolcpus)")});
  return keys;
}

LaserWiring read_wiring(TomlTable& table) {
  const ScannerMake& choice = scanner_makes()[table.choose_keys("kind")];
  LaserWiring wiring;
  wiring.kind = choice.kind;
  wiring.first_scan_limit = duration_from_seconds(table.number("first_scan_limit_s"));
  if (wiring.kind == ScannerKind::kDds) {
    wiring.topic = read_topic(table, "topic", "/scan");
    dds_laser_keys().read(table, wiring);
    return wiring;
  }
  static_cast<ByteWiring&>(wiring) = read_byte_wiring(table, "scanner", choice.port, choice.baud);
  return wiring;
}

void require_own_address(TomlTable& table, const LaserWiring& wiring, const std::vector<LaserWiring>& before) {
  for (const LaserWiring& other : before) {
    if (wiring.host == other.host && wiring.port == other.port && wiring.device == other.device)
      table.refuse(wiring.host.empty() ? "device" : "host", "is another scanner's already",
                   "give each its own address");
  }
}

RealtimeWishes read_realtime(TomlTable table) {
  RealtimeWishes wishes;
  realtime_keys().read(table, wishes);
  if (table.has("cpu")) wishes.cpu = static_cast<int>(table.integer("cpu"));
  table.finish();
  return wishes;
}

panel::JoystickSetup read_panel(TomlTable table, StickUse& steering) {
  panel::JoystickSetup joystick;
  joystick.path = table.text("joystick");
  panel_keys().read(table, joystick);
  joystick.asks_device = true;
  joystick.dead_man_renew = duration_from_seconds(table.number("dead_man_renew_s"));
  if (joystick.dead_man_renew > Duration{0} && !joystick.needs_dead_man)
    table.refuse("dead_man_renew_s", "has no dead man to renew", "set needs_dead_man = true, or leave it out");
  if (table.has("steering")) steering = static_cast<StickUse>(table.choice("steering"));  // in the enumeration's order
  if (steering != StickUse::kNone && !joystick.needs_dead_man)
    table.refuse("steering", "has no dead man", "set needs_dead_man = true, or steering = \"none\"");
  joystick.steers = steering != StickUse::kNone;
  require_distinct(table, {"dead_man_button", "stop_button", "reset_button"});
  table.finish();
  return joystick;
}

void read_map(TomlTable table, ControlSetup& setup) {
  setup.known_map = load_known_map(table.existing_file("yaml"), setup.planner().cell_m);
  table.finish();
}

NamedPlace read_place(TomlTable& table, const std::vector<NamedPlace>& before, const ControlSetup& setup) {
  NamedPlace place{.name = table.text("name"), .order = {}};
  const auto is_of_a_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  };
  if (!is_place_name(place.name) || !std::all_of(place.name.begin(), place.name.end(), is_of_a_name))
    table.refuse("name", "is no name for a place", "begin with a letter; letters, digits, _ and - go on");
  for (const NamedPlace& other : before)
    if (other.name == place.name) table.refuse("name", "is another place's already", "give each its own");
  const auto at = table.place_in_map("at", 2);
  place.order.position_in_map = {at[0], at[1]};
  require_goal_outside(setup.zones, {at[0], at[1]}, setup.model.footprint.inscribed_radius_m(), table.place_of("at"));
  if (at.size() == 3) place.order.heading_rad = wrap_angle(at[2]);
  table.finish();
  return place;
}

}  // namespace

const BoundKeys<canopen::DriveSettings>& canopen_keys() {
  using canopen::DriveSettings;
  static const BoundKeys<DriveSettings> keys(
      "drive:cia402", {whole_row("controller_node", &DriveSettings::controller_node, kNodes, "",
                                 "the node whose heartbeat the drives watch: this program"),
                       whole_row("controller_timeout_ms", &DriveSettings::controller_timeout_ms, {40.0, 100.0}, "ms",
                                 "without that heartbeat a drive stops by itself; at least two of the loop's periods"),
                       whole_row("heartbeat_ms", &DriveSettings::heartbeat_ms, {5.0, 100.0}, "ms",
                                 "the drives' own heartbeat; missed for three of these, a drive counts as lost")});
  return keys;
}

const FileKeys& robot_file_keys() {
  static const FileKeys keys = file_keys(
      "Robot file", {top_keys(), first_scanner_keys(), dds_laser_keys().keys(), other_scanner_keys(),
                     laser_keys("laser"), drive_keys(),
                     axis_keys("cia402", 2.0, "counts_per_wheel_turn",
                               "encoder counts a turn of the wheel, gear included", {12.0, 1e8}),
                     axis_keys("odrive", 1.0, "motor_turns_per_wheel_turn", "the gear", {0.1, 1000.0}),
                     axis_keys("vesc", 1.0, "electrical_turns_per_wheel_turn", "gear times pole pairs", {1.0, 1e5}),
                     canopen_keys().keys(), ros_keys(), pioneer_keys(), panel_keys().keys(), place_keys(), zone_keys(),
                     realtime_keys().keys()});
  return keys;
}

RobotFile load_robot_file(const std::filesystem::path& path) {
  const TomlFile file(path, robot_file_keys());
  TomlTable root = file.root();
  root.refuse_other_file("robot", "is of a scenario: this is no robot file", "run it by jaywalk sim");
  RobotFile robot;
  ControlSetup& setup = robot.setup;
  setup.wired = true;
  setup.model = read_model_choice(root, "model");
  setup.model.limits.max_speed_mps =
      root.number("max_speed_mps", setup.model.limits.max_speed_mps, setup.model.limits.max_speed_mps);
  const Comfort comfort = read_comfort(root);
  setup.model.limits = limits_for(comfort, setup.model);
  setup.comfort_distance_m = profile_of(comfort).comfort_distance_m;
  if (root.has("start")) {
    const auto start = root.place_in_map("start", 3);
    setup.start = {start[0], start[1], wrap_angle(start[2])};
    robot.knows_start = true;
  }
  setup.goal = setup.start.position();
  setup.goal_tolerance_m = root.number("goal_tolerance_m");
  robot.goal_heading_tolerance_rad = root.number("goal_heading_tolerance_rad");
  setup.rate_hz = root.number("rate_hz");
  std::vector<LaserWiring> wirings;
  read_lasers(root.table_or_tables("laser"), setup.model, [&](TomlTable& laser, LaserModel&) {
    const LaserWiring wiring = read_wiring(laser);
    if (!wirings.empty() && wiring.kind == ScannerKind::kDds)
      laser.refuse("kind", "brings the first scanner alone", "write that [[laser]] first, and wire the others");
    require_own_address(laser, wiring, wirings);
    wirings.push_back(wiring);
  });
  robot.laser = wirings.front();
  robot.other_lasers.assign(wirings.begin() + 1, wirings.end());
  const DriveModel nominal = setup.model.drive;
  robot.drive = read_drive(root.table("drive"), setup.model, setup.tick());
  if (root.has("realtime")) robot.realtime = read_realtime(root.table("realtime"));
  if (root.has("panel")) robot.panel = read_panel(root.table("panel"), setup.steering);
  setup.zones = read_zones(root);
  if (root.has("map")) read_map(root.table("map"), setup);
  for (TomlTable& table : root.tables("places")) robot.places.push_back(read_place(table, robot.places, setup));
  robot.control_socket = root.text("control_socket", "");
  root.finish();
  require_plausible(robot, nominal, path.string());
  require_zone_in_reach(setup.model, setup.tick(), path.string());
  return robot;
}

}  // namespace jaywalk
