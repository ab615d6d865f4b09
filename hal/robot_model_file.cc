#include "hal/robot_model_file.h"

#include <cmath>

#include "hal/shown_text.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {
namespace {

constexpr double kFarthestMountM = 10.0;  // of a laser from the axle: robots are 5 m long at most
constexpr double kRadPerDeg = kPi / 180.0;

Footprint read_footprint(TomlTable table) {
  const Footprint footprint{.front_m = table.number("front_m"),
                            .rear_m = table.number("rear_m"),
                            .half_width_m = table.number("half_width_m")};
  table.finish();
  return footprint;
}

DriveModel read_drive(TomlTable table) {
  const DriveModel drive{.wheel_radius_m = table.number("wheel_radius_m"),
                         .track_width_m = table.number("track_width_m"),
                         .max_wheel_speed_radps = table.number("max_wheel_speed_radps")};
  table.finish();
  return drive;
}

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

MotionLimits read_limits(TomlTable table) {
  const MotionLimits limits{.max_speed_mps = table.number("max_speed_mps"),
                            .max_turn_radps = table.number("max_turn_radps"),
                            .max_accel_mps2 = table.number("max_accel_mps2"),
                            .max_turn_accel_radps2 = table.number("max_turn_accel_radps2"),
                            .max_jerk_mps3 = table.number("max_jerk_mps3"),
                            .brake_mps2 = table.number("brake_mps2")};
  table.finish();
  return limits;
}

}  // namespace

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

Comfort read_comfort(TomlTable& table) {
  return table.has("comfort") ? static_cast<Comfort>(table.choice("comfort")) : Comfort::kNormal;
}

RobotModel load_robot_model(const std::filesystem::path& path) {
  const TomlFile file(path, robot_model_keys());
  TomlTable root = file.root();
  RobotModel model;
  model.name = root.text("name", path.stem().string());
  model.footprint = read_footprint(root.table("footprint"));
  model.drive = read_drive(root.table("drive"));
  model.limits = read_limits(root.table("limits"));
  read_lasers(root.table_or_tables("laser"), model, [](TomlTable&, LaserModel&) {});
  root.finish();
  return model;
}

RobotModel robot_model(const std::string& choice) {
  if (choice == "p3dx") return p3dx();
  if (choice == "wheelchair") return wheelchair();
  return load_robot_model(choice);
}

RobotModel read_model_choice(TomlTable& table, const std::string& key) {
  const std::string choice = table.text(key);
  if (choice == "p3dx") return p3dx();
  if (choice == "wheelchair") return wheelchair();
  return load_robot_model(table.existing_file(
      key, did_you_mean(choice, {"p3dx", "wheelchair"}, "write p3dx, wheelchair, or a robot model file's path")));
}

}  // namespace jaywalk
