#include "hal/robot_model_file.h"

#include <algorithm>

#include "hal/shown_text.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {
namespace {

constexpr double kFarthestMountM = 10.0;  // of a laser from the axle: robots are 5 m long at most
constexpr double kRadPerDeg = kPi / 180.0;

/// [[laser.blanked]], in degrees of the laser's own frame.
Blanking read_blanked(TomlTable& laser) {
  Blanking sectors;
  for (TomlTable table : laser.tables("blanked")) {
    const BlankedSector sector = read_sector(table);
    table.finish();
    if (!sectors.push_back(sector))
      table.refuse("from_deg", "begins one sector more than " + std::to_string(Blanking::capacity()), "join some");
  }
  return sectors;
}

using enum KeyKind;

constexpr Range kBodyMetres{0.01, 5.0}, kSectorDegrees{-360.0, 360.0};

const BoundKeys<Footprint> kFootprintKeys(
    "footprint",
    {number_row("front_m", &Footprint::front_m, kBodyMetres, "m", "from the drive axle to the foremost point"),
     number_row("rear_m", &Footprint::rear_m, kBodyMetres, "m", "from the drive axle to the rearmost point"),
     number_row("half_width_m", &Footprint::half_width_m, kBodyMetres, "m", "half of the robot's width")},
    kNeeded);

const BoundKeys<DriveModel> kDriveKeys(
    "drive",
    {number_row("wheel_radius_m", &DriveModel::wheel_radius_m, {0.02, 0.5}, "m", "of a driven wheel"),
     number_row("track_width_m", &DriveModel::track_width_m, {0.05, 3.0}, "m", "between the wheels' contact points"),
     number_row("max_wheel_speed_radps", &DriveModel::max_wheel_speed_radps, {0.1, 500.0}, "rad/s",
                "the motors' top speed")},
    kNeeded);

const BoundKeys<MotionLimits> kLimitKeys(
    "limits",
    {number_row("max_speed_mps", &MotionLimits::max_speed_mps, {0.01, 10.0}, "m/s", "cruising speed"),
     number_row("max_turn_radps", &MotionLimits::max_turn_radps, {0.01, 10.0}, "rad/s", "fastest turn"),
     number_row("max_accel_mps2", &MotionLimits::max_accel_mps2, {0.01, 20.0}, "m/s2",
                "comfort: speeding up and slowing down as planned"),
     number_row("max_turn_accel_radps2", &MotionLimits::max_turn_accel_radps2, {0.01, 50.0}, "rad/s2",
                "comfort: the same of turning"),
     number_row("max_jerk_mps3", &MotionLimits::max_jerk_mps3, {0.01, 1000.0}, "m/s3",
                "comfort: change of acceleration"),
     number_row("brake_mps2", &MotionLimits::brake_mps2, {0.01, 20.0}, "m/s2",
                "braking that the drive is proved to be able to do; stops rely on it")},
    kNeeded);

}  // namespace

const std::vector<std::string>& comfort_names() {
  static const std::vector<std::string> names{"gentle", "normal", "brisk"};
  return names;
}

// Gentle and brisk were chosen, not tuned; docs/reference/scenarios.md has what they come to.
ComfortProfile profile_of(Comfort comfort) noexcept {
  switch (comfort) {
    case Comfort::kGentle: return {.speed = 0.65, .accel = 0.6, .jerk = 0.6, .comfort_distance_m = 1.5};
    case Comfort::kBrisk: return {.speed = 1.0, .accel = 1.6, .jerk = 1.2, .comfort_distance_m = 0.75};
    case Comfort::kNormal: break;
  }
  return {};
}

MotionLimits limits_for(Comfort comfort, const RobotModel& model) noexcept {
  const ComfortProfile profile = profile_of(comfort);
  const auto capped = [](double own, double share, double most) { return std::min(own * share, std::max(own, most)); };
  MotionLimits limits = model.limits;
  limits.max_speed_mps *= profile.speed;
  limits.max_turn_radps *= profile.speed;
  limits.max_accel_mps2 = capped(limits.max_accel_mps2, profile.accel, kMostComfortAccel_mps2);
  limits.max_turn_accel_radps2 *= std::min(profile.accel, 1.0);
  limits.max_jerk_mps3 = capped(limits.max_jerk_mps3, profile.jerk, kMostComfortJerk_mps3);
  return limits;
}

BlankedSector read_sector(TomlTable& table) {
  const BlankedSector sector{wrap_angle(table.number("from_deg") * kRadPerDeg),
                             wrap_angle(table.number("to_deg") * kRadPerDeg)};
  if (sector.width_rad() == 0.0)
    table.refuse("to_deg", "is where the sector begins", "give the end, counter-clockwise from there");
  return sector;
}

void read_laser(TomlTable& table, LaserModel& laser) {
  laser.fov_rad = table.number("fov_deg", laser.fov_rad / kRadPerDeg) * kRadPerDeg;
  laser.beams = static_cast<std::uint32_t>(table.integer("beams", laser.beams));
  if (laser.beams < kLeastBeams)
    table.refuse("beams", "are too few: so few beams are no scanner", "give the number that one sweep has, 3 or more");
  laser.rate_hz = table.number("rate_hz", laser.rate_hz);
  laser.range_min_m = table.number("range_min_m", laser.range_min_m);
  laser.range_max_m = table.number("range_m", laser.range_max_m);
  laser.noise_m = table.number("noise_m", laser.noise_m);
  laser.drop_out = table.number("drop_out", laser.drop_out);
  if (table.needs("mount") || table.has("mount")) {
    const auto mount = table.place_in_map("mount", 3);
    laser.robot_from_laser = {mount[0], mount[1], wrap_angle(mount[2])};
    if (norm(laser.robot_from_laser.position()) > kFarthestMountM)
      table.refuse("mount", "lies beside any robot", "give x and y from the drive axle's middle, in metres");
  }
  if (table.has("blanked")) laser.blanked = read_blanked(table);
  if (!(laser.range_min_m < laser.range_max_m)) table.refuse("range_min_m", "is not below range_m", "lower it");
}

void read_lasers(std::vector<TomlTable> tables, RobotModel& model,
                 const std::function<void(TomlTable&, LaserModel&)>& read_more) {
  const std::size_t of_model = model.lasers().size();
  if (tables.size() < of_model)
    tables.back().refuse("mount", "is the last one's, and the model has " + std::to_string(of_model) + " scanners",
                         "write [[laser]] for each, in the model's order");
  for (std::size_t k = 0; k < tables.size(); ++k) {
    TomlTable& table = tables[k];
    if (k >= of_model && !table.has("mount"))
      table.refuse("mount", "is missing, of a scanner that the model lacks", "give [x, y, yaw] on the robot");
    if (k >= of_model && !model.other_lasers.push_back(model.laser))
      table.refuse("mount", "is one scanner's more than " + std::to_string(kMostScanners), "leave it out");
    LaserModel& laser = k == 0 ? model.laser : model.other_lasers[k - 1];
    if (k >= of_model) laser.blanked.clear();
    read_more(table, laser);
    read_laser(table, laser);
    table.finish();
  }
}

RobotModel load_robot_model(const std::filesystem::path& path) {
  const TomlFile file(path, robot_model_keys());
  TomlTable root = file.root();
  RobotModel model;
  model.name = root.text("name", path.stem().string());
  model.footprint = kFootprintKeys.read(root.table("footprint"));
  model.drive = kDriveKeys.read(root.table("drive"));
  model.limits = kLimitKeys.read(root.table("limits"));
  read_lasers(root.table_or_tables("laser"), model, [](TomlTable&, LaserModel&) {});
  root.finish();
  return model;
}

RobotModel read_model_choice(TomlTable& table, const std::string& key) {
  const std::string choice = table.text(key);
  if (choice == "p3dx" || choice == "wheelchair") return robot_model(choice);
  return load_robot_model(table.existing_file(
      key, did_you_mean(choice, {"p3dx", "wheelchair"}, "write p3dx, wheelchair, or a robot model file's path")));
}

std::vector<SettingKey> laser_keys(const std::string& section, const Otherwise& otherwise, const Otherwise& of_noise) {
  const Range beams{1.0, static_cast<double>(kMaxBeams)};
  const std::string sector = section + ".blanked";
  return section_keys(
      section,
      {number_row("fov_deg", {1.0, 360.0}, "degrees", otherwise, "from the first beam to the last, centred ahead"),
       whole_row("beams", beams, "", otherwise, "of a sweep; fewer than 3 are refused"),
       number_row("rate_hz", {0.1, 100.0}, "1/s", otherwise, "sweeps a second"),
       number_row("range_min_m", {0.0, 5.0}, "m", otherwise, "the beam knows nothing of what is nearer; below range_m"),
       number_row("range_m", {0.1, 300.0}, "m", otherwise, "a beam with nothing nearer is free up to here"),
       number_row("noise_m", {0.0, 1.0}, "m", of_noise, "standard deviation of a range, simulated"),
       number_row("drop_out", {0.0, 1.0}, "", of_noise, "share of beams lost, each by itself, simulated"),
       key_row("mount", kNumbers, otherwise, "[x, y, yaw] of the laser on the robot, within 10 m", "m, m, rad"),
       key_row("blanked", kTables, "none", "where the laser sees the robot itself; 16 at most"),
       in_section(sector, number_row("from_deg", kSectorDegrees, "degrees", kNeeded,
                                     "where the sector begins, in the laser's own frame")),
       in_section(sector, number_row("to_deg", kSectorDegrees, "degrees", kNeeded,
                                     "where it ends, counter-clockwise from there"))});
}

const FileKeys& robot_model_keys() {
  static const FileKeys keys = file_keys(
      "Robot model",
      {section_keys("", {key_row("name", kText, "the file's name", "for reports"),
                         key_row("footprint", kTable, kNeeded, "the body: a rectangle about the drive axle's middle"),
                         key_row("drive", kTable, kNeeded, "wheels and motors"),
                         key_row("limits", kTable, kNeeded, "how fast it may move"),
                         key_row("laser", kTable, kNeeded, "the scanner, or [[laser]] for each")}),
       kFootprintKeys.keys(), kDriveKeys.keys(), kLimitKeys.keys(), laser_keys("laser", kNeeded, 0.0)});
  return keys;
}

}  // namespace jaywalk
