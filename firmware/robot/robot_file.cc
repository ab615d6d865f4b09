#include "firmware/robot/robot_file.h"

#include <array>
#include <cmath>

#include "hal/robot_model_file.h"
#include "hal/toml_file.h"

namespace jaywalk {
namespace {

/// The drives' own ramps lie above what the controller asks for, or they would lag behind it; the proof of 6084h and
/// 6085h then covers limits.brake_mps2.
constexpr double kRampOverBrake = 1.5;

const ScannerMake& choose_laser(TomlTable& table) {
  const std::string kind = table.text("kind");
  std::string names;
  for (const ScannerMake& choice : scanner_makes()) {
    if (kind == choice.name) return choice;
    names += (names.empty() ? "" : ", ") + std::string(choice.name);
  }
  table.refuse("kind", "is \"" + kind + "\"", "choose one of " + names);
}

LaserWiring read_wiring(TomlTable& table) {
  const ScannerMake& choice = choose_laser(table);
  LaserWiring wiring;
  wiring.kind = choice.kind;
  const bool serial = choice.port == 0 || (choice.baud != 0 && table.has("device"));
  if (serial) {
    wiring.device = table.text("device");
    wiring.baud = static_cast<std::uint32_t>(table.integer("baud", {1200, 4000000}, choice.baud));
  } else {
    wiring.host = table.text("host");
    wiring.port = static_cast<std::uint16_t>(table.integer("port", {1, 65535}, choice.port));
  }
  wiring.first_scan_limit =
      duration_from_seconds(table.number("first_scan_limit_s", {0.1, 600.0}, to_seconds(wiring.first_scan_limit)));
  return wiring;
}

struct Numbered {
  const char* key;
  std::uint16_t value;
};

/// Refuses the first that repeats one before it.
void require_distinct(const TomlTable& table, std::initializer_list<Numbered> all) {
  for (const Numbered& one : all) {
    for (const Numbered* other = all.begin(); other != &one; ++other) {
      if (one.value == other->value)
        table.refuse(one.key, std::string("is ") + other->key + " too", "give each its own");
    }
  }
}

std::uint8_t read_node(TomlTable& table, const std::string& key, std::int64_t otherwise) {
  return static_cast<std::uint8_t>(table.integer(key, {1, 127}, otherwise));
}

/// Of the left drive and the right one.
std::array<std::uint8_t, 2> read_nodes(TomlTable& table, std::int64_t left, std::int64_t right) {
  const std::array nodes{read_node(table, "left_node", left), read_node(table, "right_node", right)};
  require_distinct(table, {{"left_node", nodes[0]}, {"right_node", nodes[1]}});
  return nodes;
}

/// Wheel acceleration (m/s2 at the rim) as counts/s2.
std::uint32_t ramp(double mps2, const DriveModel& model, double counts_per_rad) {
  constexpr double kMost = 4294967295.0;
  return static_cast<std::uint32_t>(std::fmin(mps2 / model.wheel_radius_m * counts_per_rad + 0.5, kMost));
}

/// What a radian of a wheel is in the drive's own unit, `key` of them a turn; negative for a motor that is reversed.
std::array<double, 2> read_scales(TomlTable& table, const std::string& key) {
  const double per_rad = table.number(key, {1e-3, 1e9}) / (2.0 * kPi);
  const bool left = table.boolean("left_reversed", false), right = table.boolean("right_reversed", false);
  return {left ? -per_rad : per_rad, right ? -per_rad : per_rad};
}

canopen::DriveBaseSetup read_cia402(TomlTable& table, const RobotModel& model) {
  canopen::DriveBaseSetup base;
  canopen::DriveSettings& settings = base.settings;
  settings.controller_node = read_node(table, "controller_node", 1);
  settings.controller_timeout_ms = static_cast<std::uint16_t>(table.integer("controller_timeout_ms", {40, 100}, 100));
  settings.heartbeat_ms = static_cast<std::uint16_t>(table.integer("heartbeat_ms", {5, 100}, 50));
  base.silence_limit = 3 * std::chrono::milliseconds(settings.heartbeat_ms);
  base.allow_unproved = table.boolean("allow_unproved", false);
  const auto scales = read_scales(table, "counts_per_wheel_turn");
  const auto nodes = read_nodes(table, 2, 3);
  require_distinct(table,
                   {{"left_node", nodes[0]}, {"right_node", nodes[1]}, {"controller_node", settings.controller_node}});
  base.axes = {canopen::AxisSetup{nodes[0], scales[0]}, canopen::AxisSetup{nodes[1], scales[1]}};
  settings.acceleration = settings.deceleration = settings.quick_stop =
      ramp(kRampOverBrake * model.limits.brake_mps2, model.drive, std::fabs(scales[0]));
  return base;
}

DriveWiring read_drive(TomlTable table, const RobotModel& model) {
  DriveWiring wiring;
  const std::string kind = table.text("kind");
  wiring.can = table.text("can");
  if (kind == "cia402") {
    wiring.cia402 = read_cia402(table, model);
  } else if (kind == "odrive") {
    wiring.kind = DriveKind::kOdrive;
    const auto scales = read_scales(table, "motor_turns_per_wheel_turn");
    const auto nodes = read_nodes(table, 1, 2);
    wiring.odrive.axes = {odrive::AxisSetup{nodes[0], scales[0]}, odrive::AxisSetup{nodes[1], scales[1]}};
    wiring.odrive.allow_unproved = table.boolean("allow_unproved", false);
  } else if (kind == "vesc") {
    wiring.kind = DriveKind::kVesc;
    const auto scales = read_scales(table, "electrical_turns_per_wheel_turn");
    const auto nodes = read_nodes(table, 1, 2);
    wiring.vesc.axes = {vesc::AxisSetup{nodes[0], scales[0]}, vesc::AxisSetup{nodes[1], scales[1]}};
    wiring.vesc.allow_unproved = table.boolean("allow_unproved", false);
  } else {
    table.refuse("kind", "is \"" + kind + "\"", "choose cia402, odrive or vesc");
  }
  table.finish();
  return wiring;
}

RealtimeWishes read_realtime(TomlTable table) {
  RealtimeWishes wishes;
  wishes.priority = static_cast<int>(table.integer("priority", {0, 98}, wishes.priority));
  wishes.lock_memory = table.boolean("lock_memory", wishes.lock_memory);
  if (table.has("cpu")) wishes.cpu = static_cast<int>(table.integer("cpu", {0, 1023}));
  table.finish();
  return wishes;
}

PanelWiring read_panel(TomlTable table) {
  PanelWiring panel;
  panel::JoystickSetup& joystick = panel.joystick;
  const auto button = [&table](const char* key, std::uint16_t otherwise) {
    return static_cast<std::uint16_t>(table.integer(key, {0, 0x2FF}, otherwise));
  };
  joystick.path = table.text("joystick");
  panel.needs_dead_man = table.boolean("needs_dead_man", panel.needs_dead_man);
  joystick.dead_man = button("dead_man_button", joystick.dead_man);
  joystick.stop = button("stop_button", joystick.stop);
  joystick.stop_opens = table.boolean("stop_opens", joystick.stop_opens);
  joystick.reset = button("reset_button", joystick.reset);
  require_distinct(
      table,
      {{"dead_man_button", joystick.dead_man}, {"stop_button", joystick.stop}, {"reset_button", joystick.reset}});
  table.finish();
  return panel;
}

}  // namespace

RobotFile load_robot_file(const std::filesystem::path& path) {
  const TomlFile file(path);
  TomlTable root = file.root();
  RobotFile robot;
  ControlSetup& setup = robot.setup;
  setup.wired = true;
  setup.model = read_model_choice(root, "model");
  setup.model.limits.max_speed_mps =
      root.number("max_speed_mps", {0.05, setup.model.limits.max_speed_mps}, setup.model.limits.max_speed_mps);
  if (root.has("start")) {
    const auto start = root.numbers("start", 3);
    setup.start = {start[0], start[1], wrap_angle(start[2])};
  }
  setup.goal = setup.start.position();
  setup.goal_tolerance_m = root.number("goal_tolerance_m", {0.05, 5.0}, setup.goal_tolerance_m);
  robot.goal_heading_tolerance_rad =
      root.number("goal_heading_tolerance_rad", {0.02, kPi}, robot.goal_heading_tolerance_rad);
  setup.rate_hz = root.number("rate_hz", {20.0, 200.0}, setup.rate_hz);
  TomlTable laser = root.table("laser");
  robot.laser = read_wiring(laser);
  read_laser(laser, setup.model.laser);
  laser.finish();
  robot.drive = read_drive(root.table("drive"), setup.model);
  if (root.has("realtime")) robot.realtime = read_realtime(root.table("realtime"));
  if (root.has("panel")) robot.panel = read_panel(root.table("panel"));
  robot.control_socket = root.text("control_socket", "");
  root.finish();
  return robot;
}

}  // namespace jaywalk
