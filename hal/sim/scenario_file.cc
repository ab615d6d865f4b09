
#include <algorithm>
#include <array>
#include <utility>

#include "hal/map_zones_file.h"
#include "hal/robot_model_file.h"
#include "hal/sim/scenario.h"

namespace jaywalk::sim {
namespace {

using enum KeyKind;

constexpr Range kSeconds{0.0, 86400.0};
constexpr Range kDegrees{-360.0, 360.0};
constexpr Range kWheel{0.01, 1.0}, kTrack{0.05, 3.0};  // as a model's
constexpr Range kRadius{0.01, 1.0};  // a mover wider than this could brush a wall that its zone does not see
constexpr const char* kModels = "the model's";
constexpr const char* kLegs = "the laser sees two legs that walk, not a disc";
const Scenario kScenario{};

const BoundKeys<Scenario> kWorldKeys(
    "", {key_row("name", kText, "the file's name", "for reports"),
         whole_row("seed", &Scenario::seed, {0.0, 9e18}, "", "decides everything random; --seed overrides it"),
         number_row("timeout_s", &Scenario::timeout_s, {0.1, 86400.0}, "s", "the run ends then"),
         key_row("map", kTable, kNeeded, "the world: one of yaml, aria, cylinders"),
         key_row("robot", kTable, kNeeded, "the robot in it"),
         key_row("stick", kTable, "none", "a scripted person who drives by a stick; the goal is where it should lead"),
         key_row("movers", kTables, "none", "what moves"), key_row("faults", kTables, "none", "what goes wrong")});

const std::vector<SettingKey> kMapKeys =
    section_keys("map", {key_row("yaml", kFile, "another kind", "ROS map_server file"),
                         key_row("aria", kFile, "another kind", "MobileSim / ARIA map"),
                         key_row("cylinders", kFile, "another kind", "a line \"x y radius\" (m) each"),
                         key_row("known", kBoolean, kScenario.map_is_known, "the robot has it")});

const BoundKeys<Scenario> kRobotKeys(
    "robot",
    {key_row("start", kNumbers, kNeeded, "[x, y, heading] of the drive axle's middle", "m, m, rad"),
     key_row("goal", kNumbers, kNeeded, "[x, y] or [x, y, heading]", "m, m, rad"),
     number_row("goal_tolerance_m", &Scenario::goal_tolerance_m, {0.01, 10.0}, "m",
                "the goal counts as reached within this"),
     number_row("goal_heading_tolerance_rad", &Scenario::goal_heading_tolerance_rad, {0.01, kPi}, "rad",
                "and within this of its heading"),
     key_row("model", kText, "\"p3dx\"", "\"p3dx\", \"wheelchair\", or a robot model file"),
     number_row("max_speed_mps", {0.01, 500.0}, "m/s", kModels, "cruising speed; at most what the wheels can do"),
     comfort_key(), key_row("laser", kTable, kModels, "over the model's own, or [[robot.laser]] for each"),
     key_row("slip", kTable, "the defaults", "how the wheels slip, as shares of their speed"),
     key_row("truth", kTable, "as its model", "what the robot really is; the controller is not told"),
     key_row("reports", kTable, "100 a second", "how the wheels' motion is reported"),
     key_row("pose_source", kTable, "none", "a localisation system outside the robot, as the paper has")});

const BoundKeys<LaserModel> kTurningKeys("robot.laser",
                                         {boolean_row("turns", &LaserModel::turns,
                                                      "beams are measured one after another, as the scanner turns")});

const BoundKeys<SlipSpec> kSlipKeys("robot.slip",
                                    {number_row("mean", &SlipSpec::mean, {0.0, 0.5}, "",
                                                "both wheels turn so much more than the ground passes"),
                                     number_row("std", &SlipSpec::std, {0.0, 0.5}, "",
                                                "standard deviation of each wheel by itself, correlated over 1 s")});

const std::vector<SettingKey> kReportKeys =
    section_keys("robot.reports",
                 {number_row("period_ms", {1.0, 250.0}, "ms", 1e3 * ReportSpec{}.period_s, "between two"),
                  number_row("late_ms", {0.0, 200.0}, "ms", 1e3 * ReportSpec{}.late_s, "each comes up to so late")});

const BoundKeys<TrueRobot> kTruthKeys(
    "robot.truth",
    {number_row("left_wheel_radius_m", &TrueRobot::left_wheel_radius_m, kWheel, "m", kModels, "of the left wheel"),
     number_row("right_wheel_radius_m", &TrueRobot::right_wheel_radius_m, kWheel, "m", kModels, "of the right wheel"),
     number_row("track_width_m", &TrueRobot::track_width_m, kTrack, "m", kModels, "between the wheels' contact points"),
     {key_row("laser_mount", kNumbers, kModels, "[x, y, yaw] of the first laser on the robot", "m, m, rad"),
      [](TomlTable& table, TrueRobot& truth) {
        if (!table.has("laser_mount")) return;
        const auto mount = table.place_in_map("laser_mount", 3);
        truth.robot_from_laser = {mount[0], mount[1], wrap_angle(mount[2])};
      }}});

const BoundKeys<PoseSourceSpec> kPoseSourceKeys(
    "robot.pose_source",
    {{key_row("enabled", kBoolean, true, "false: as if the table were missing"),
      [](TomlTable& table, PoseSourceSpec& spec) { spec.enabled = table.boolean("enabled"); }},
     number_row("rate_hz", &PoseSourceSpec::rate_hz, {0.1, 100.0}, "1/s", "fixes a second"),
     number_row("position_std_m", &PoseSourceSpec::position_std_m, {0.0, 10.0}, "m", "noise of the robot's x and y"),
     number_row("heading_std_rad", &PoseSourceSpec::heading_std_rad, {0.0, 3.0}, "rad", "noise of its heading"),
     number_row("mover_std_m", &PoseSourceSpec::mover_std_m, {0.0, 10.0}, "m", "noise of each mover's x and y"),
     boolean_row("gives_movers", &PoseSourceSpec::gives_movers,
                 "the robot takes movers from it, not from its laser; --mode paper always does")});

const BoundKeys<StickSpec> kStickKeys(
    "stick",
    {choice_row("kind", kNeeded, "ahead whatever comes, pointed at the goal, or by rows",
                {"straight", "to_goal", "table"}),
     choice_row("steering", "shared",
                "shared: the robot steers clear and stops by itself; by_hand: the supervisor alone does",
                {"shared", "by_hand"}),
     number_row("delay_s", &StickSpec::delay_s, {0.0, 2.0}, "s", "from what is so to what the hand does"),
     number_row("noise_std", &StickSpec::noise_std, {0.0, 1.0}, "", "of the hand, a share of the stick's way")});

/// Of a stick that no table moves.
const std::vector<SettingKey> kPushKeys{
    number_row("forward", {0.0, 1.0}, "", StickSpec{}.forward, "how far it is pushed")};

const BoundKeys<WanderSpec> kWanderKeys(
    "movers:wander", {with_default(whole_row("count", &WanderSpec::count, {0.0, 500.0}, "", "how many"), kNeeded),
                      number_row("speed_mps", &WanderSpec::speed_mps, {0.0, 5.0}, "m/s", "constant while walking"),
                      number_row("radius_m", &WanderSpec::radius_m, kRadius, "m", "of the disc"),
                      number_row("turn_rate_radps", &WanderSpec::turn_rate_radps, {0.01, 50.0}, "rad/s", "in place"),
                      number_row("spontaneous_turns_hz", &WanderSpec::spontaneous_turns_hz, {0.0, 10.0}, "1/s",
                                 "turns for no reason, a second of walking"),
                      boolean_row("legs", &WanderSpec::legs, kLegs)});

const BoundKeys<SocialSpec> kSocialKeys(
    "movers:social", {with_default(whole_row("count", &SocialSpec::count, {0.0, 500.0}, "", "how many"), kNeeded),
                      number_row("speed_mps", &SocialSpec::speed_mps, {0.1, 3.0}, "m/s",
                                 "mean of the wished speeds, which differ by 19 %"),
                      number_row("radius_m", &SocialSpec::radius_m, kRadius, "m", "of the disc"),
                      whole_row("group", &SocialSpec::group, {1.0, 10.0}, "", "so many walk together"),
                      {choice_row("reaction", "regular", "what the sight of the robot does; mixed: each in turn",
                                  // in the order of Reaction
                                  {"regular", "surprised", "curious", "afraid", "hurried", "mixed"}),
                       [](TomlTable& table, SocialSpec& spec) {
                         if (table.has("reaction")) spec.reaction = static_cast<Reaction>(table.choice("reaction"));
                       }},
                      boolean_row("legs", &SocialSpec::legs, kLegs)});

const BoundKeys<RecordedSpec> kRecordedKeys(
    "movers:recorded",
    {{key_row("file", kFile, kNeeded, "rows of t_s,id,x_m,y_m below a line that says so"),
      [](TomlTable& table, RecordedSpec& spec) { spec.file = table.existing_file("file"); }},
     number_row("radius_m", &RecordedSpec::radius_m, kRadius, "m", "of the disc"),
     {key_row("offset", kNumbers, "[0, 0]", "[x, y] added to every place", "m, m"),
      [](TomlTable& table, RecordedSpec& spec) {
        if (!table.has("offset")) return;
        const auto offset = table.numbers("offset", 2);
        spec.offset = {offset[0], offset[1]};
      }},
     number_row("start_at_s", &RecordedSpec::start_at_s, {-86400.0, 86400.0}, "s", "when the first row happens"),
     boolean_row("loop", &RecordedSpec::loop, "begins anew after the last row"),
     boolean_row("legs", &RecordedSpec::legs, kLegs)});

const BoundKeys<FaultSpec> kFaultKeys(
    "faults",
    {choice_row("kind", kNeeded, "what goes wrong (scenarios.md says what each does)",
                // in the order of FaultKind
                {"scan_stale", "scan_nan", "scan_short", "scan_frozen", "beams_lost", "wheels_stale", "wheel_slip",
                 "emergency_stop", "no_grip", "both_motors_reversed", "left_motor_reversed", "left_wheel_reversed",
                 "wheels_swapped", "left_wheel_stuck", "scanner_mirrored", "carried", "rain"}),
     with_default(number_row("at_s", &FaultSpec::at_s, kSeconds, "s", "when it begins"), kNeeded),
     with_default(number_row("for_s", &FaultSpec::for_s, kSeconds, "s", "how long it lasts"), kNeeded),
     with_default(whole_row("scanner", &FaultSpec::scanner, {1.0, static_cast<double>(kMostScanners)}, "",
                            "which scanner has it"),
                  "all")});

const std::vector<SettingKey> kLostBeamsKeys = section_keys(
    "faults:beams_lost",
    {number_row("from_deg", kDegrees, "degrees", "-60",
                "where the sector begins, in the laser's frame; needed with to_deg"),
     number_row("to_deg", kDegrees, "degrees", "60", "where it ends, counter-clockwise; needed with from_deg"),
     key_row("claims_free", kBoolean, FaultSpec{}.claims_free,
             "whether its beams say that nothing is within reach; else that they measured nothing")});

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

/// The robot knows it of its drive.
ReportSpec read_reports(TomlTable table, DriveTimes& known) {
  const ReportSpec spec{1e-3 * table.number("period_ms"), 1e-3 * table.number("late_ms")};
  known.report_s = std::max(known.report_s, spec.period_s);
  known.late_s = spec.late_s;
  table.finish();
  return spec;
}

RobotModel read_model(TomlTable& table) {
  RobotModel model = table.has("model") ? read_model_choice(table, "model") : p3dx();
  const double fastest = model.drive.max_wheel_speed_radps * model.drive.wheel_radius_m;
  model.limits.max_speed_mps = table.number("max_speed_mps", model.limits.max_speed_mps, fastest);
  if (table.has("laser"))
    read_lasers(table.table_or_tables("laser"), model,
                [](TomlTable& laser, LaserModel& of) { kTurningKeys.read(laser, of); });
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
  kRobotKeys.read(table, scenario);
  scenario.model = read_model(table);
  scenario.comfort = read_comfort(table);
  scenario.model.limits = limits_for(scenario.comfort, scenario.model);
  if (table.has("slip")) scenario.slip = kSlipKeys.read(table.table("slip"));
  if (table.has("truth")) scenario.truth = kTruthKeys.read(table.table("truth"));
  if (table.has("reports")) scenario.reports = read_reports(table.table("reports"), scenario.model.drive.times);
  if (table.has("pose_source")) scenario.pose_source = kPoseSourceKeys.read(table.table("pose_source"));
  table.finish();
}

StickSpec read_stick(TomlTable table) {
  StickSpec spec;
  spec.kind = static_cast<StickKind>(table.choose_keys("kind"));  // choices in the enumerations' orders
  if (table.has("steering")) spec.steering = table.choice("steering") == 0 ? StickUse::kShared : StickUse::kByHand;
  kStickKeys.read(table, spec);
  if (spec.kind == StickKind::kTable)
    spec.file = table.existing_file("file");
  else
    spec.forward = table.number("forward");
  table.finish();
  return spec;
}

void read_movers(TomlTable& table, Scenario& scenario) {
  const std::size_t kind = table.choose_keys("kind");
  if (kind == 0) scenario.wanderers.push_back(kWanderKeys.read(table));
  if (kind == 1) scenario.recorded.push_back(kRecordedKeys.read(table));
  if (kind == 2) scenario.social.push_back(kSocialKeys.read(table));
}

FaultSpec read_fault(TomlTable& table) {
  FaultSpec spec;
  spec.kind = static_cast<FaultKind>(table.choose_keys("kind"));  // the choices are in the enumeration's order
  kFaultKeys.read(table, spec);
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

const FileKeys& scenario_keys() {
  static const FileKeys keys = file_keys(
      "Scenario",
      {kWorldKeys.keys(),
       kMapKeys,
       kRobotKeys.keys(),
       kTurningKeys.keys(),
       kSlipKeys.keys(),
       kReportKeys,
       kTruthKeys.keys(),
       kPoseSourceKeys.keys(),
       laser_keys("robot.laser"),
       zone_keys(),
       kStickKeys.keys(),
       section_keys("stick:table",
                    {key_row("file", kFile, kNeeded, "rows of t_s,forward,left below a line that says so")}),
       section_keys("stick:straight", kPushKeys),
       section_keys("stick:to_goal", kPushKeys),
       section_keys("movers", {choice_row("kind", kNeeded,
                                          "walk about, walk as somebody once did, or react to each other and the robot",
                                          {"wander", "recorded", "social"})}),
       kWanderKeys.keys(),
       kRecordedKeys.keys(),
       kSocialKeys.keys(),
       kFaultKeys.keys(),
       kLostBeamsKeys,
       section_keys("faults:carried",
                    {key_row("way", kNumbers, kNeeded, "x, y, heading of where it is put down, from where it stood",
                             "m, m, rad")})});
  return keys;
}

Scenario load_scenario(const std::filesystem::path& path, const std::vector<std::string>& settings) {
  const TomlFile file(path, scenario_keys(), settings);
  TomlTable root = file.root();
  Scenario scenario;
  scenario.name = root.text("name", path.stem().string());
  kWorldKeys.read(root, scenario);
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
