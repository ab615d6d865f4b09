#include "firmware/robot/robot_file.h"

#include <algorithm>
#include <cctype>

#include "firmware/recording/map_files.h"
#include "firmware/robot/robot_file_keys.h"
#include "firmware/safety/stop_zone.h"
#include "hal/map_zones_file.h"
#include "hal/robot_model_file.h"
#include "hal/toml_file.h"

namespace jaywalk {
namespace {

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

PanelWiring read_panel(TomlTable table, StickUse& steering) {
  PanelWiring panel;
  panel::JoystickSetup& joystick = panel.joystick;
  joystick.path = table.text("joystick");
  panel.needs_dead_man = table.boolean("needs_dead_man");
  joystick.asks_device = true;
  joystick.needs_dead_man = panel.needs_dead_man;
  joystick.dead_man_renew = duration_from_seconds(table.number("dead_man_renew_s"));
  if (joystick.dead_man_renew > Duration{0} && !panel.needs_dead_man)
    table.refuse("dead_man_renew_s", "has no dead man to renew", "set needs_dead_man = true, or leave it out");
  if (table.has("steering")) steering = static_cast<StickUse>(table.choice("steering"));  // in the enumeration's order
  if (steering != StickUse::kNone && !panel.needs_dead_man)
    table.refuse("steering", "has no dead man", "set needs_dead_man = true, or steering = \"none\"");
  joystick.steers = steering != StickUse::kNone;
  button_keys().read(table, joystick);
  require_distinct(
      table,
      {{"dead_man_button", joystick.dead_man}, {"stop_button", joystick.stop}, {"reset_button", joystick.reset}});
  table.finish();
  return panel;
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
