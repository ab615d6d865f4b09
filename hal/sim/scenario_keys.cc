#include "hal/map_zones_file.h"
#include "hal/robot_model_file.h"
#include "hal/sim/scenario.h"

namespace jaywalk::sim {
namespace {

using enum KeyKind;

constexpr Range kSeconds{0.0, 86400.0};
constexpr Range kWheel{0.01, 1.0}, kTrack{0.05, 3.0};  // as a model's
constexpr const char* kModels = "the model's";
constexpr Range kRadius{0.01, 1.0};  // a mover wider than this could brush a wall that its zone does not see
const Scenario kScenario{};
const WanderSpec kWander{};
const RecordedSpec kRecorded{};
const PoseSourceSpec kPoseSource{};
const SlipSpec kSlip{};
const ReportSpec kReports{};
const StickSpec kStick{};

std::vector<SettingKey> world_keys() {
  return {{"", "name", kText, {}, "", "the file's name", "for reports"},
          {"",
           "seed",
           kInteger,
           {0.0, 9e18},
           "",
           static_cast<double>(kScenario.seed),
           "decides everything random; --seed overrides it"},
          {"", "timeout_s", kNumber, {0.1, 86400.0}, "s", kScenario.timeout_s, "the run ends then"},
          {"", "map", kTable, {}, "", kNeeded, "the world: one of yaml, aria, cylinders"},
          {"", "robot", kTable, {}, "", kNeeded, "the robot in it"},
          {"",
           "stick",
           kTable,
           {},
           "",
           "none",
           "a scripted person who drives by a stick; the goal is where it should lead"},
          {"", "movers", kTables, {}, "", "none", "what moves"},
          {"", "faults", kTables, {}, "", "none", "what goes wrong"},
          {"map", "yaml", kFile, {}, "", "another kind", "ROS map_server file"},
          {"map", "aria", kFile, {}, "", "another kind", "MobileSim / ARIA map"},
          {"map", "cylinders", kFile, {}, "", "another kind", "a line \"x y radius\" (m) each"},
          {"map", "known", kBoolean, {}, "", kScenario.map_is_known, "the robot has it"}};
}

std::vector<SettingKey> robot_keys() {
  return {
      {"robot", "start", kNumbers, {}, "m, m, rad", kNeeded, "[x, y, heading] of the drive axle's middle"},
      {"robot", "goal", kNumbers, {}, "m, m, rad", kNeeded, "[x, y] or [x, y, heading]"},
      {"robot",
       "goal_tolerance_m",
       kNumber,
       {0.01, 10.0},
       "m",
       kScenario.goal_tolerance_m,
       "the goal counts as reached within this"},
      {"robot",
       "goal_heading_tolerance_rad",
       kNumber,
       {0.01, kPi},
       "rad",
       kScenario.goal_heading_tolerance_rad,
       "and within this of its heading"},
      {"robot", "model", kText, {}, "", "\"p3dx\"", "\"p3dx\", \"wheelchair\", or a robot model file"},
      {"robot",
       "max_speed_mps",
       kNumber,
       {0.01, 500.0},
       "m/s",
       "the model's",
       "cruising speed; at most what the wheels can do"},
      comfort_key("robot"),
      {"robot", "laser", kTable, {}, "", "the model's", "over the model's own, or [[robot.laser]] for each"},
      {"robot", "slip", kTable, {}, "", "the defaults", "how the wheels slip, as shares of their speed"},
      {"robot", "truth", kTable, {}, "", "as its model", "what the robot really is; the controller is not told"},
      {"robot", "reports", kTable, {}, "", "100 a second", "how the wheels' motion is reported"},
      {"robot", "pose_source", kTable, {}, "", "none", "a localisation system outside the robot, as the paper has"}};
}

/// The tables below [robot].
std::vector<SettingKey> robot_table_keys() {
  return {{"robot.laser",
           "turns",
           kBoolean,
           {},
           "",
           LaserModel{}.turns,
           "beams are measured one after another, as the scanner turns"},
          {"robot.slip",
           "mean",
           kNumber,
           {0.0, 0.5},
           "",
           kSlip.mean,
           "both wheels turn so much more than the ground passes"},
          {"robot.slip",
           "std",
           kNumber,
           {0.0, 0.5},
           "",
           kSlip.std,
           "standard deviation of each wheel by itself, correlated over 1 s"},
          {"robot.reports", "period_ms", kNumber, {1.0, 250.0}, "ms", 1e3 * kReports.period_s, "between two"},
          {"robot.reports", "late_ms", kNumber, {0.0, 200.0}, "ms", 1e3 * kReports.late_s, "each comes up to so late"},
          {"robot.truth", "left_wheel_radius_m", kNumber, kWheel, "m", kModels, "of the left wheel"},
          {"robot.truth", "right_wheel_radius_m", kNumber, kWheel, "m", kModels, "of the right wheel"},
          {"robot.truth", "track_width_m", kNumber, kTrack, "m", kModels, "between the wheels' contact points"},
          {"robot.truth",
           "laser_mount",
           kNumbers,
           {},
           "m, m, rad",
           kModels,
           "[x, y, yaw] of the first laser on the robot"}};
}

std::vector<SettingKey> pose_source_keys() {
  return {{"robot.pose_source", "enabled", kBoolean, {}, "", true, "false: as if the table were missing"},
          {"robot.pose_source", "rate_hz", kNumber, {0.1, 100.0}, "1/s", kPoseSource.rate_hz, "fixes a second"},
          {"robot.pose_source",
           "position_std_m",
           kNumber,
           {0.0, 10.0},
           "m",
           kPoseSource.position_std_m,
           "noise of the robot's x and y"},
          {"robot.pose_source",
           "heading_std_rad",
           kNumber,
           {0.0, 3.0},
           "rad",
           kPoseSource.heading_std_rad,
           "noise of its heading"},
          {"robot.pose_source",
           "mover_std_m",
           kNumber,
           {0.0, 10.0},
           "m",
           kPoseSource.mover_std_m,
           "noise of each mover's x and y"},
          {"robot.pose_source",
           "gives_movers",
           kBoolean,
           {},
           "",
           kPoseSource.gives_movers,
           "the robot takes movers from it, not from its laser; --mode paper always does"}};
}

std::vector<SettingKey> stick_keys() {
  std::vector<SettingKey> keys{
      {"stick",
       "kind",
       kChoice,
       {},
       "",
       kNeeded,
       "ahead whatever comes, pointed at the goal, or by rows",
       {"straight", "to_goal", "table"}},
      {"stick",
       "steering",
       kChoice,
       {},
       "",
       "shared",
       "shared: the robot steers clear and stops by itself; by_hand: the supervisor alone does",
       {"shared", "by_hand"}},
      {"stick", "delay_s", kNumber, {0.0, 2.0}, "s", kStick.delay_s, "from what is so to what the hand does"},
      {"stick", "noise_std", kNumber, {0.0, 1.0}, "", kStick.noise_std, "of the hand, a share of the stick's way"},
      {"stick:table", "file", kFile, {}, "", kNeeded, "rows of t_s,forward,left below a line that says so"}};
  for (const char* kind : {"stick:straight", "stick:to_goal"})
    keys.push_back({kind, "forward", kNumber, {0.0, 1.0}, "", kStick.forward, "how far it is pushed"});
  return keys;
}

std::vector<SettingKey> mover_keys() {
  return {
      {"movers", "kind", kChoice, {}, "", kNeeded, "walk about, or walk as somebody once did", {"wander", "recorded"}},
      {"movers:wander", "count", kInteger, {0.0, 500.0}, "", kNeeded, "how many"},
      {"movers:wander", "speed_mps", kNumber, {0.0, 5.0}, "m/s", kWander.speed_mps, "constant while walking"},
      {"movers:wander", "radius_m", kNumber, kRadius, "m", kWander.radius_m, "of the disc"},
      {"movers:wander", "turn_rate_radps", kNumber, {0.01, 50.0}, "rad/s", kWander.turn_rate_radps, "in place"},
      {"movers:wander",
       "spontaneous_turns_hz",
       kNumber,
       {0.0, 10.0},
       "1/s",
       kWander.spontaneous_turns_hz,
       "turns for no reason, a second of walking"},
      {"movers:wander", "legs", kBoolean, {}, "", kWander.legs, "the laser sees two legs that walk, not a disc"},
      {"movers:recorded", "file", kFile, {}, "", kNeeded, "rows of t_s,id,x_m,y_m below a line that says so"},
      {"movers:recorded", "radius_m", kNumber, kRadius, "m", kRecorded.radius_m, "of the disc"},
      {"movers:recorded", "offset", kNumbers, {}, "m, m", "[0, 0]", "[x, y] added to every place"},
      {"movers:recorded",
       "start_at_s",
       kNumber,
       {-86400.0, 86400.0},
       "s",
       kRecorded.start_at_s,
       "when the first row happens"},
      {"movers:recorded", "loop", kBoolean, {}, "", kRecorded.loop, "begins anew after the last row"},
      {"movers:recorded", "legs", kBoolean, {}, "", kRecorded.legs, "the laser sees two legs that walk, not a disc"}};
}

std::vector<SettingKey> fault_keys() {
  constexpr Range kDegrees{-360.0, 360.0};
  return {{"faults",
           "kind",
           kChoice,
           {},
           "",
           kNeeded,
           "what goes wrong (scenarios.md says what each does)",
           // in the order of FaultKind
           {"scan_stale", "scan_nan", "scan_short", "scan_frozen", "beams_lost", "wheels_stale", "wheel_slip",
            "emergency_stop", "no_grip", "both_motors_reversed", "left_motor_reversed", "left_wheel_reversed",
            "wheels_swapped", "left_wheel_stuck", "scanner_mirrored", "carried", "rain"}},
          {"faults", "at_s", kNumber, kSeconds, "s", kNeeded, "when it begins"},
          {"faults", "for_s", kNumber, kSeconds, "s", kNeeded, "how long it lasts"},
          {"faults", "scanner", kInteger, {1.0, static_cast<double>(kMostScanners)}, "", "all", "which scanner has it"},
          {"faults:beams_lost", "from_deg", kNumber, kDegrees, "degrees", "-60",
           "where the sector begins, in the laser's frame; needed with to_deg"},
          {"faults:beams_lost", "to_deg", kNumber, kDegrees, "degrees", "60",
           "where it ends, counter-clockwise; needed with from_deg"},
          {"faults:beams_lost",
           "claims_free",
           kBoolean,
           {},
           "",
           FaultSpec{}.claims_free,
           "whether its beams say that nothing is within reach; else that they measured nothing"},
          {"faults:carried",
           "way",
           kNumbers,
           {},
           "m, m, rad",
           kNeeded,
           "x, y, heading of where it is put down, from where it stood"}};
}

FileKeys make_scenario_keys() {
  FileKeys file{"Scenario", {}};
  for (const auto& keys : {world_keys(), robot_keys(), robot_table_keys(), pose_source_keys(),
                           laser_keys("robot.laser"), zone_keys(), stick_keys(), mover_keys(), fault_keys()})
    file.keys.insert(file.keys.end(), keys.begin(), keys.end());
  return file;
}

}  // namespace

const FileKeys& scenario_keys() {
  static const FileKeys keys = make_scenario_keys();
  return keys;
}

}  // namespace jaywalk::sim
