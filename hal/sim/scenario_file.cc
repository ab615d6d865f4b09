#include <algorithm>
#include <array>
#include <utility>

#include "hal/map_zones_file.h"
#include "hal/robot_model_file.h"
#include "hal/sim/scenario.h"

namespace jaywalk::sim {
namespace {

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
  scenario.map_is_known = table.boolean("known");
  table.finish();
  if (scenario.map_is_known && scenario.map_kind != MapKind::kYaml)
    table.refuse("known", "only a map with yaml tells what is free", "leave it out, or give yaml");
  if (found != 1) table.refuse("yaml", "or aria or cylinders: one is needed", "name exactly one map");
}

PoseSourceSpec read_pose_source(TomlTable table) {
  PoseSourceSpec spec;
  spec.enabled = table.boolean("enabled");
  spec.rate_hz = table.number("rate_hz");
  spec.position_std_m = table.number("position_std_m");
  spec.heading_std_rad = table.number("heading_std_rad");
  spec.mover_std_m = table.number("mover_std_m");
  spec.gives_movers = table.boolean("gives_movers");
  table.finish();
  return spec;
}

SlipSpec read_slip(TomlTable table) {
  SlipSpec spec;
  spec.mean = table.number("mean");
  spec.std = table.number("std");
  table.finish();
  return spec;
}

/// The robot knows it of its drive.
ReportSpec read_reports(TomlTable table, DriveTimes& known) {
  const ReportSpec spec{1e-3 * table.number("period_ms"), 1e-3 * table.number("late_ms")};
  known.report_s = std::max(known.report_s, spec.period_s);
  known.late_s = spec.late_s;
  table.finish();
  return spec;
}

TrueRobot read_truth(TomlTable table) {
  TrueRobot truth;
  const auto read = [&table](const char* key, std::optional<double>& into) {
    if (table.has(key)) into = table.number(key);
  };
  read("left_wheel_radius_m", truth.left_wheel_radius_m);
  read("right_wheel_radius_m", truth.right_wheel_radius_m);
  read("track_width_m", truth.track_width_m);
  if (table.has("laser_mount")) {
    const auto mount = table.place_in_map("laser_mount", 3);
    truth.robot_from_laser = {mount[0], mount[1], wrap_angle(mount[2])};
  }
  table.finish();
  return truth;
}

RobotModel read_model(TomlTable& table) {
  RobotModel model = table.has("model") ? read_model_choice(table, "model") : p3dx();
  const double fastest = model.drive.max_wheel_speed_radps * model.drive.wheel_radius_m;
  model.limits.max_speed_mps = table.number("max_speed_mps", model.limits.max_speed_mps, fastest);
  if (table.has("laser"))
    read_lasers(table.table_or_tables("laser"), model,
                [](TomlTable& laser, LaserModel& of) { of.turns = laser.boolean("turns", of.turns); });
  return model;
}

void read_robot(TomlTable table, Scenario& scenario) {
  const auto start = table.place_in_map("start", 3);
  scenario.start = {start[0], start[1], wrap_angle(start[2])};
  const auto goal = table.place_in_map("goal", 2);
  scenario.goal = {goal[0], goal[1]};
  if (goal.size() == 3) scenario.goal_heading_rad = wrap_angle(goal[2]);
  scenario.start_place = table.place_of("start");
  scenario.goal_place = table.place_of("goal");
  scenario.goal_tolerance_m = table.number("goal_tolerance_m");
  scenario.goal_heading_tolerance_rad = table.number("goal_heading_tolerance_rad");
  scenario.model = read_model(table);
  scenario.comfort = read_comfort(table);
  scenario.model.limits = limits_for(scenario.comfort, scenario.model);
  if (table.has("slip")) scenario.slip = read_slip(table.table("slip"));
  if (table.has("truth")) scenario.truth = read_truth(table.table("truth"));
  if (table.has("reports")) scenario.reports = read_reports(table.table("reports"), scenario.model.drive.times);
  if (table.has("pose_source")) scenario.pose_source = read_pose_source(table.table("pose_source"));
  table.finish();
}

StickSpec read_stick(TomlTable table) {
  StickSpec spec;
  spec.kind = static_cast<StickKind>(table.choose_keys("kind"));  // choices in the enumerations' orders
  if (table.has("steering")) spec.steering = table.choice("steering") == 0 ? StickUse::kShared : StickUse::kByHand;
  spec.delay_s = table.number("delay_s");
  spec.noise_std = table.number("noise_std");
  if (spec.kind == StickKind::kTable) {
    spec.file = table.existing_file("file");
  } else {
    spec.forward = table.number("forward");
  }
  table.finish();
  return spec;
}

WanderSpec read_wanderers(TomlTable& table) {
  WanderSpec spec;
  spec.count = static_cast<int>(table.integer("count"));
  spec.speed_mps = table.number("speed_mps");
  spec.radius_m = table.number("radius_m");
  spec.turn_rate_radps = table.number("turn_rate_radps");
  spec.spontaneous_turns_hz = table.number("spontaneous_turns_hz");
  spec.legs = table.boolean("legs");
  return spec;
}

RecordedSpec read_recorded(TomlTable& table) {
  RecordedSpec spec;
  spec.file = table.existing_file("file");
  spec.radius_m = table.number("radius_m");
  if (table.has("offset")) {
    const auto offset = table.numbers("offset", 2);
    spec.offset = {offset[0], offset[1]};
  }
  spec.start_at_s = table.number("start_at_s");
  spec.loop = table.boolean("loop");
  spec.legs = table.boolean("legs");
  return spec;
}

void read_movers(TomlTable& table, Scenario& scenario) {
  if (table.choose_keys("kind") == 0) {
    scenario.wanderers.push_back(read_wanderers(table));
  } else {
    scenario.recorded.push_back(read_recorded(table));
  }
  table.finish();
}

FaultSpec read_fault(TomlTable& table) {
  FaultSpec spec;
  spec.kind = static_cast<FaultKind>(table.choose_keys("kind"));  // the choices are in the enumeration's order
  spec.at_s = table.number("at_s");
  spec.for_s = table.number("for_s");
  if (table.has("scanner")) spec.scanner = static_cast<int>(table.integer("scanner"));
  if (spec.kind == FaultKind::kBeamsLost && (table.has("from_deg") || table.has("to_deg")))
    spec.lost = read_sector(table);
  if (spec.kind == FaultKind::kBeamsLost) spec.claims_free = table.boolean("claims_free");
  if (spec.kind == FaultKind::kCarried) {
    const std::vector<double> way = table.numbers("way", 3);
    spec.way = {way[0], way[1], way[2]};
  }
  table.finish();
  return spec;
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& path, const std::vector<std::string>& settings) {
  const TomlFile file(path, scenario_keys(), settings);
  TomlTable root = file.root();
  Scenario scenario;
  scenario.name = root.text("name", path.stem().string());
  scenario.seed = static_cast<std::uint64_t>(root.integer("seed"));
  scenario.timeout_s = root.number("timeout_s");
  read_map(root.table("map"), scenario);
  read_robot(root.table("robot"), scenario);
  scenario.zones = read_zones(root);
  require_goal_outside(scenario.zones, scenario.goal, scenario.model.footprint.inscribed_radius_m(),
                       scenario.goal_place);
  if (root.has("stick")) scenario.stick = read_stick(root.table("stick"));
  for (TomlTable& table : root.tables("movers")) read_movers(table, scenario);
  for (TomlTable& table : root.tables("faults")) {
    scenario.faults.push_back(read_fault(table));
    if (scenario.faults.back().scanner > static_cast<int>(scenario.model.lasers().size()))
      table.refuse("scanner", "is none of this robot's", "count its [[robot.laser]] from 1, or leave it out");
  }
  root.finish();
  return scenario;
}

}  // namespace jaywalk::sim
