#pragma once
// A scenario file (docs/reference/scenarios.md): the world, the robot in it, what moves, what goes wrong.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/maps/wall_map.h"
#include "hal/robot_model_file.h"
#include "hal/setting_keys.h"
#include "hal/types/geometry.h"
#include "hal/types/map_zones.h"
#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"

namespace jaywalk::sim {

struct WanderSpec {
  int count = 0;
  double speed_mps = 0.4;
  double radius_m = 0.27;
  double turn_rate_radps = 1.0;
  double spontaneous_turns_hz = 0.0;
  bool legs = false;
};

/// Reactions of a social mover to the robot, in the order of the scenario's words (social_walkers.h).
enum class Reaction : std::uint8_t { kRegular, kSurprised, kCurious, kAfraid, kHurried, kMixed };

struct SocialSpec {
  int count = 0;
  double speed_mps = 1.34;
  double radius_m = 0.25;
  int group = 1;  ///< so many walk together
  Reaction reaction = Reaction::kRegular;
  bool legs = false;
};

struct RecordedSpec {
  std::filesystem::path file;
  double radius_m = 0.25;
  Vec2 offset{};
  double start_at_s = 0.0;
  bool loop = false;
  bool legs = false;
};

enum class FaultKind {
  kScanStale,
  kScanNan,
  kScanShort,
  kScanFrozen,
  kBeamsLost,
  kWheelsStale,
  kWheelSlip,
  kEmergencyStop,
  kNoGrip,              ///< both wheels turn, the robot stands
  kBothMotorsReversed,  ///< the encoders tell the truth
  kLeftMotorReversed,   ///< likewise
  kLeftWheelReversed,   ///< motor and encoder: the feedback obeys
  kWheelsSwapped,       ///< drives, motors and encoders: left is right
  kLeftWheelStuck,
  kScannerMirrored,  ///< upside down, or its sense of rotation taken the wrong way round
  kCarried,          ///< a person lifts the robot and puts it down elsewhere: its wheels stand
  kRain              ///< 0.5 % of the beams end at drops, 0.1 to 0.3 m off
};

struct FaultSpec {
  double at_s = 0.0;
  double for_s = 0.0;
  FaultKind kind = FaultKind::kScanStale;
  BlankedSector lost{-kPi / 3.0, kPi / 3.0};  ///< of kBeamsLost, in the laser's frame: 120 degrees ahead
  bool claims_free = false;                   ///< of kBeamsLost: its beams say that nothing is within reach
  Pose2 way{};                                ///< of kCarried: to where, from where it stood then
  int scanner = 0;                            ///< of the scanner's faults: which one's, from 1; 0: all

  [[nodiscard]] bool is_of(std::size_t which) const noexcept {
    return scanner == 0 || scanner == static_cast<int>(which) + 1;
  }
  [[nodiscard]] bool active(double now_s) const noexcept { return now_s >= at_s && now_s < at_s + for_s; }
};

/// How the wheels slip: shares of a wheel's speed that the ground does not see.
struct SlipSpec {
  double mean = 0.0;   ///< of both wheels, always
  double std = 0.005;  ///< of each by itself, about the mean: Gaussian, correlated over kSlipTime (plant.h)
};

/// What the robot really is, where that differs from its model, which is all that the controller knows.
struct TrueRobot {
  std::optional<double> left_wheel_radius_m, right_wheel_radius_m, track_width_m;
  std::optional<Pose2> robot_from_laser;
};

/// Timing of the simulated wheels' reports.
struct ReportSpec {
  double period_s = 0.01;
  double late_s = 0.0;  ///< each comes up to so much later, in order, and is stamped as it comes
};

struct PoseSourceSpec {
  bool enabled = false;
  double rate_hz = 5.0;
  double position_std_m = 0.03;
  double heading_std_rad = 0.01;
  double mover_std_m = 0.05;
  bool gives_movers = false;  ///< the robot takes movers from it, not from its laser; in mode paper always
};

enum class StickKind { kStraight, kToGoal, kTable };

/// A scripted person who drives by a stick (ScriptedStick).
struct StickSpec {
  StickKind kind = StickKind::kStraight;
  StickUse steering = StickUse::kShared;
  double forward = 1.0;          ///< how far it is pushed, 0 to 1
  double noise_std = 0.0;        ///< of the hand, a share of the stick's way, both ways
  double delay_s = 0.2;          ///< from what is so to what the hand does
  std::filesystem::path file{};  ///< of a table
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  double timeout_s = 180.0;
  MapKind map_kind = MapKind::kYaml;
  std::filesystem::path map_file;
  bool map_is_known = false;  ///< to the robot, before it sees anything
  Pose2 start;
  Vec2 goal;
  std::string start_place, goal_place;  ///< "office.toml:12: ", for complaints; empty for a scenario from no file
  double goal_tolerance_m = 0.3;
  double goal_heading_rad = kAnyHeading;  ///< wanted at the goal, in the map; NaN: any
  double goal_heading_tolerance_rad = 0.1;
  RobotModel model;  ///< with the scenario's own speed, comfort and laser already in it
  Comfort comfort = Comfort::kNormal;
  SlipSpec slip;
  TrueRobot truth;
  ReportSpec reports;
  PoseSourceSpec pose_source;
  std::optional<StickSpec> stick;
  std::vector<MapZone> zones;
  std::vector<WanderSpec> wanderers;
  std::vector<RecordedSpec> recorded;
  std::vector<SocialSpec> social;
  std::vector<FaultSpec> faults;
};

[[nodiscard]] const FileKeys& scenario_keys();

/// Throws StartupError "FILE:LINE: cause; remedy". `settings`, KEY=VALUE each, stand in place of the file's own.
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& settings = {});

}  // namespace jaywalk::sim
