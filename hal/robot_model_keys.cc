#include "hal/robot_model_file.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {
namespace {

using enum KeyKind;

constexpr Range kBodyMetres{0.01, 5.0};
constexpr const char* kModels = "the model's";

void add_blanked(std::vector<SettingKey>& keys, const std::string& section) {
  constexpr Range kDegrees{-360.0, 360.0};
  keys.push_back({section, "blanked", kTables, {}, "", "none", "where the laser sees the robot itself; 16 at most"});
  keys.push_back({section + ".blanked", "from_deg", kNumber, kDegrees, "degrees", kNeeded,
                  "where the sector begins, in the laser's own frame"});
  keys.push_back({section + ".blanked", "to_deg", kNumber, kDegrees, "degrees", kNeeded,
                  "where it ends, counter-clockwise from there"});
}

/// `otherwise` of what a model's own file must have.
std::vector<SettingKey> laser_keys_with(const std::string& section, const Otherwise& otherwise,
                                        const Otherwise& of_noise) {
  const Range beams{1.0, static_cast<double>(kMaxBeams)};
  std::vector<SettingKey> keys{
      {section,
       "fov_deg",
       kNumber,
       {1.0, 360.0},
       "degrees",
       otherwise,
       "from the first beam to the last, centred ahead"},
      {section, "beams", kInteger, beams, "", otherwise, "of a sweep; fewer than 3 are refused"},
      {section, "rate_hz", kNumber, {0.1, 100.0}, "1/s", otherwise, "sweeps a second"},
      {section,
       "range_min_m",
       kNumber,
       {0.0, 5.0},
       "m",
       otherwise,
       "the beam knows nothing of what is nearer; below range_m"},
      {section, "range_m", kNumber, {0.1, 300.0}, "m", otherwise, "a beam with nothing nearer is free up to here"},
      {section, "noise_m", kNumber, {0.0, 1.0}, "m", of_noise, "standard deviation of a range, simulated"},
      {section, "drop_out", kNumber, {0.0, 1.0}, "", of_noise, "share of beams lost, each by itself, simulated"},
      {section, "mount", kNumbers, {}, "m, m, rad", otherwise, "[x, y, yaw] of the laser on the robot, within 10 m"}};
  add_blanked(keys, section);
  return keys;
}

void add_drive_and_body(std::vector<SettingKey>& keys) {
  for (const SettingKey& key : std::vector<SettingKey>{
           {"footprint", "front_m", kNumber, kBodyMetres, "m", kNeeded, "from the drive axle to the foremost point"},
           {"footprint", "rear_m", kNumber, kBodyMetres, "m", kNeeded, "from the drive axle to the rearmost point"},
           {"footprint", "half_width_m", kNumber, kBodyMetres, "m", kNeeded, "half of the robot's width"},
           {"drive", "wheel_radius_m", kNumber, {0.02, 0.5}, "m", kNeeded, "of a driven wheel"},
           {"drive", "track_width_m", kNumber, {0.05, 3.0}, "m", kNeeded, "between the wheels' contact points"},
           {"drive", "max_wheel_speed_radps", kNumber, {0.1, 500.0}, "rad/s", kNeeded, "the motors' top speed"}})
    keys.push_back(key);
}

void add_limits(std::vector<SettingKey>& keys) {
  const auto add = [&keys](const char* key, Range range, const char* unit, const char* meaning) {
    keys.push_back({"limits", key, kNumber, range, unit, kNeeded, meaning});
  };
  add("max_speed_mps", {0.01, 10.0}, "m/s", "cruising speed");
  add("max_turn_radps", {0.01, 10.0}, "rad/s", "fastest turn");
  add("max_accel_mps2", {0.01, 20.0}, "m/s2", "comfort: speeding up and slowing down as planned");
  add("max_turn_accel_radps2", {0.01, 50.0}, "rad/s2", "comfort: the same of turning");
  add("max_jerk_mps3", {0.01, 1000.0}, "m/s3", "comfort: change of acceleration");
  add("brake_mps2", {0.01, 20.0}, "m/s2", "braking that the drive is proved to be able to do; stops rely on it");
}

FileKeys make_robot_model_keys() {
  FileKeys file{"Robot model", {}};
  file.keys = {{"", "name", kText, {}, "", "the file's name", "for reports"},
               {"", "footprint", kTable, {}, "", kNeeded, "the body: a rectangle about the drive axle's middle"},
               {"", "drive", kTable, {}, "", kNeeded, "wheels and motors"},
               {"", "limits", kTable, {}, "", kNeeded, "how fast it may move"},
               {"", "laser", kTable, {}, "", kNeeded, "the scanner, or [[laser]] for each"}};
  add_drive_and_body(file.keys);
  add_limits(file.keys);
  for (const SettingKey& key : laser_keys_with("laser", kNeeded, 0.0)) file.keys.push_back(key);
  return file;
}

}  // namespace

SettingKey comfort_key(const std::string& section) {
  return {section,
          "comfort",
          KeyKind::kChoice,
          {},
          "",
          "\"normal\"",
          "speed, acceleration, jerk and distance from people, from the model's limits (scenarios.md)",
          comfort_names()};
}

std::vector<SettingKey> laser_keys(const std::string& section) { return laser_keys_with(section, kModels, kModels); }

const FileKeys& robot_model_keys() {
  static const FileKeys keys = make_robot_model_keys();
  return keys;
}

}  // namespace jaywalk
