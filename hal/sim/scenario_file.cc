#include <array>
#include <utility>

#include "hal/robot_model_file.h"
#include "hal/sim/scenario.h"

namespace jaywalk::sim {
namespace {

constexpr Range kSeconds{0.0, 86400.0};
constexpr Range kRadius{0.01, 1.0};  // a mover wider than this could brush a wall that its zone does not see

void read_map(TomlTable table, Scenario& scenario) {
  constexpr std::array<std::pair<const char*, MapKind>, 3> kKinds{
      {{"yaml", MapKind::kYaml}, {"aria", MapKind::kAria}, {"cylinders", MapKind::kCylinders}}};
  int found = 0;
  for (const auto& [key, kind] : kKinds) {
    if (!table.has(key)) continue;
    scenario.map_kind = kind;
    scenario.map_file = table.existing_file(key);
    ++found;
  }
  table.finish();
  if (found != 1) table.refuse("yaml", "or aria or cylinders: one is needed", "name exactly one map");
}

PoseSourceSpec read_pose_source(TomlTable table) {
  PoseSourceSpec spec;
  spec.enabled = table.boolean("enabled", true);
  spec.rate_hz = table.number("rate_hz", {0.1, 100.0}, spec.rate_hz);
  spec.position_std_m = table.number("position_std_m", {0.0, 10.0}, spec.position_std_m);
  spec.heading_std_rad = table.number("heading_std_rad", {0.0, 3.0}, spec.heading_std_rad);
  spec.mover_std_m = table.number("mover_std_m", {0.0, 10.0}, spec.mover_std_m);
  table.finish();
  return spec;
}

SlipSpec read_slip(TomlTable table) {
  SlipSpec spec;
  spec.mean = table.number("mean", {0.0, 0.5}, spec.mean);
  spec.std = table.number("std", {0.0, 0.5}, spec.std);
  table.finish();
  return spec;
}

RobotModel read_model(TomlTable& table, bool& laser_turns) {
  RobotModel model = table.has("model") ? read_model_choice(table, "model") : p3dx();
  const double fastest = model.drive.max_wheel_speed_radps * model.drive.wheel_radius_m;
  model.limits.max_speed_mps = table.number("max_speed_mps", {0.01, fastest}, model.limits.max_speed_mps);
  if (table.has("laser")) {
    TomlTable laser = table.table("laser");
    read_laser(laser, model.laser);
    laser_turns = laser.boolean("turns", laser_turns);
    laser.finish();
  }
  return model;
}

void read_robot(TomlTable table, Scenario& scenario) {
  const auto start = table.numbers("start", 3);
  scenario.start = {start[0], start[1], wrap_angle(start[2])};
  const auto goal = table.numbers("goal", 2, 3);
  scenario.goal = {goal[0], goal[1]};
  if (goal.size() == 3) scenario.goal_heading_rad = wrap_angle(goal[2]);
  scenario.start_place = table.place_of("start");
  scenario.goal_place = table.place_of("goal");
  scenario.goal_tolerance_m = table.number("goal_tolerance_m", {0.01, 10.0}, scenario.goal_tolerance_m);
  scenario.goal_heading_tolerance_rad =
      table.number("goal_heading_tolerance_rad", {0.01, kPi}, scenario.goal_heading_tolerance_rad);
  scenario.model = read_model(table, scenario.laser_turns);
  if (table.has("slip")) scenario.slip = read_slip(table.table("slip"));
  if (table.has("pose_source")) scenario.pose_source = read_pose_source(table.table("pose_source"));
  table.finish();
}

WanderSpec read_wanderers(TomlTable& table) {
  WanderSpec spec;
  spec.count = static_cast<int>(table.integer("count", {0.0, 500.0}));
  spec.speed_mps = table.number("speed_mps", {0.0, 5.0}, spec.speed_mps);
  spec.radius_m = table.number("radius_m", kRadius, spec.radius_m);
  spec.turn_rate_radps = table.number("turn_rate_radps", {0.01, 50.0}, spec.turn_rate_radps);
  spec.spontaneous_turns_hz = table.number("spontaneous_turns_hz", {0.0, 10.0}, spec.spontaneous_turns_hz);
  spec.legs = table.boolean("legs", spec.legs);
  return spec;
}

RecordedSpec read_recorded(TomlTable& table) {
  RecordedSpec spec;
  spec.file = table.existing_file("file");
  spec.radius_m = table.number("radius_m", kRadius, spec.radius_m);
  if (table.has("offset")) {
    const auto offset = table.numbers("offset", 2);
    spec.offset = {offset[0], offset[1]};
  }
  spec.start_at_s = table.number("start_at_s", {-86400.0, 86400.0}, spec.start_at_s);
  spec.loop = table.boolean("loop", spec.loop);
  spec.legs = table.boolean("legs", spec.legs);
  return spec;
}

void read_movers(TomlTable& table, Scenario& scenario) {
  const std::string kind = table.text("kind");
  if (kind == "wander") {
    scenario.wanderers.push_back(read_wanderers(table));
  } else if (kind == "recorded") {
    scenario.recorded.push_back(read_recorded(table));
  } else {
    table.refuse("kind", "is \"" + kind + "\"", "write \"wander\" or \"recorded\"");
  }
  table.finish();
}

FaultSpec read_fault(TomlTable& table) {
  constexpr std::array<std::pair<const char*, FaultKind>, 15> kKinds{{
      {"scan_stale", FaultKind::kScanStale},
      {"scan_nan", FaultKind::kScanNan},
      {"scan_short", FaultKind::kScanShort},
      {"scan_frozen", FaultKind::kScanFrozen},
      {"beams_lost", FaultKind::kBeamsLost},
      {"wheels_stale", FaultKind::kWheelsStale},
      {"wheel_slip", FaultKind::kWheelSlip},
      {"emergency_stop", FaultKind::kEmergencyStop},
      {"no_grip", FaultKind::kNoGrip},
      {"both_motors_reversed", FaultKind::kBothMotorsReversed},
      {"left_motor_reversed", FaultKind::kLeftMotorReversed},
      {"left_wheel_reversed", FaultKind::kLeftWheelReversed},
      {"wheels_swapped", FaultKind::kWheelsSwapped},
      {"left_wheel_stuck", FaultKind::kLeftWheelStuck},
      {"scanner_mirrored", FaultKind::kScannerMirrored},
  }};
  FaultSpec spec;
  spec.at_s = table.number("at_s", kSeconds);
  spec.for_s = table.number("for_s", kSeconds);
  const std::string name = table.text("kind");
  const bool has_sector = table.has("from_deg") || table.has("to_deg");
  if (name == "beams_lost" && has_sector) spec.lost = read_sector(table);
  table.finish();
  std::string known;
  for (const auto& [text, kind] : kKinds) {
    if (name == text) {
      spec.kind = kind;
      return spec;
    }
    known += std::string(known.empty() ? "" : ", ") + text;
  }
  table.refuse("kind", "is \"" + name + "\"", "write one of " + known);
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& path) {
  const TomlFile file(path);
  TomlTable root = file.root();
  Scenario scenario;
  scenario.name = root.text("name", path.stem().string());
  scenario.seed = static_cast<std::uint64_t>(root.integer("seed", {0.0, 9e18}, 1));
  scenario.timeout_s = root.number("timeout_s", {0.1, 86400.0}, scenario.timeout_s);
  read_map(root.table("map"), scenario);
  read_robot(root.table("robot"), scenario);
  for (TomlTable& table : root.tables("movers")) read_movers(table, scenario);
  for (TomlTable& table : root.tables("faults")) scenario.faults.push_back(read_fault(table));
  root.finish();
  return scenario;
}

}  // namespace jaywalk::sim
