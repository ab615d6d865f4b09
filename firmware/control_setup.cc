#include "firmware/control_setup.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "hal/types/errors.h"

namespace jaywalk {

// One macro a struct, both ways; field names are the file format's.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Vec2, x, y)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Pose2, x, y, heading)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Footprint, front_m, rear_m, half_width_m)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DriveModel, wheel_radius_m, track_width_m, max_wheel_speed_radps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MotionLimits, max_speed_mps, max_turn_radps, max_accel_mps2, max_turn_accel_radps2,
                                   max_jerk_mps3, brake_mps2)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LaserModel, robot_from_laser, fov_rad, beams, rate_hz, range_min_m, range_max_m,
                                   noise_m, drop_out)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RobotModel, name, footprint, drive, limits, laser)
NLOHMANN_JSON_SERIALIZE_ENUM(ZoneKind, {{ZoneKind::kKeepOut, "keep_out"}, {ZoneKind::kSpeed, "speed"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MapZone, kind, corners, speed_mps)
NLOHMANN_JSON_SERIALIZE_ENUM(PlanMode, {{PlanMode::kFull, "full"}, {PlanMode::kPaper, "paper"}})
NLOHMANN_JSON_SERIALIZE_ENUM(StickUse,
                             {{StickUse::kNone, "none"}, {StickUse::kShared, "shared"}, {StickUse::kByHand, "by_hand"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Backend, {{Backend::kAuto, "auto"}, {Backend::kCpu, "cpu"}, {Backend::kCuda, "cuda"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ControlSetup, model, mode, constant_speed, backend, start, goal, goal_tolerance_m,
                                   wheels, wired, rate_hz, judges_motion)

namespace {

constexpr double kCell_m = 0.1;  // the paper's
/// What a robot that is nearly round may plan with beyond the circle inside it.
constexpr double kMarginOverInscribed_m = 0.15;
constexpr double kNearlyRound_m = 0.16;  ///< between the two circles; a P3-DX: 0.158 m

nlohmann::json json_of(const Blanking& blanked) {
  nlohmann::json sectors = nlohmann::json::array();
  for (const BlankedSector& sector : blanked) sectors.push_back({sector.from_rad, sector.to_rad});
  return sectors;
}

/// Those of `json` where it has any.
Blanking blanked_of(const nlohmann::json& json) {
  Blanking blanked;
  for (const auto& [from, to] : json.value("blanked", std::vector<std::array<double, 2>>{}))
    (void)blanked.push_back({from, to});  // no more than were written
  return blanked;
}

nlohmann::json json_of(const LaserModel& laser) {
  nlohmann::json json(laser);
  json["blanked"] = json_of(laser.blanked);
  return json;
}

LaserModel laser_of(const nlohmann::json& json) {
  auto laser = json.get<LaserModel>();
  laser.blanked = blanked_of(json);
  return laser;
}

nlohmann::json json_of(const DriveTimes& times) { return {times.report_s, times.late_s, times.response_s}; }

/// Drive times in a recording's head; the usual ones where it has none, as earlier versions wrote it.
DriveTimes drive_times_of(const nlohmann::json& json) {
  if (!json.contains("drive_times")) return {};
  const auto [report_s, late_s, response_s] = json["drive_times"].get<std::array<double, 3>>();
  return {report_s, late_s, response_s};
}

/// Runs of equal cells: "12u3f1w".
std::string runs_of(const std::vector<KnownCell>& cells) {
  std::string text;
  for (std::size_t k = 0; k < cells.size();) {
    const std::size_t first = k;
    while (k < cells.size() && cells[k] == cells[first]) ++k;
    text += std::to_string(k - first) + "ufw"[static_cast<std::size_t>(cells[first])];
  }
  return text;
}

/// Throws std::invalid_argument where these are no runs of so many cells.
std::vector<KnownCell> cells_of(const std::string& runs, std::size_t count) {
  std::vector<KnownCell> cells;
  std::size_t length = 0;
  for (const char c : runs) {
    if (c >= '0' && c <= '9') length = 10 * length + static_cast<std::size_t>(c - '0');
    if (length > count) throw std::invalid_argument("runs of too many cells");
    if (c >= '0' && c <= '9') continue;
    const std::size_t kind = std::string("ufw").find(c);
    if (kind == std::string::npos || cells.size() + length > count) throw std::invalid_argument("no runs of cells");
    cells.insert(cells.end(), length, static_cast<KnownCell>(kind));
    length = 0;
  }
  if (cells.size() != count) throw std::invalid_argument("runs of too few cells");
  return cells;
}

nlohmann::json json_of(const KnownMap& map) {
  return {{"cell_m", map.cell_m},
          {"low", {map.low.i, map.low.j}},
          {"size", {map.width, map.height}},
          {"cells", runs_of(map.cells)}};
}

std::shared_ptr<const KnownMap> known_map_of(const nlohmann::json& json) {
  const auto low = json.at("low").get<std::array<std::int32_t, 2>>();
  const auto size = json.at("size").get<std::array<std::int32_t, 2>>();
  if (size[0] < 1 || size[1] < 1 || size[0] > kMostKnownCells || size[1] > kMostKnownCells)
    throw std::invalid_argument("a map of no size");
  KnownMap map{json.at("cell_m").get<double>(), {low[0], low[1]}, size[0], size[1], {}};
  map.cells = cells_of(json.at("cells").get<std::string>(),
                       static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]));
  return std::make_shared<const KnownMap>(std::move(map));
}

}  // namespace

bool ControlSetup::has_long_body() const {
  const Footprint& body = model.footprint;
  return !keeps_speed() && body.circumscribed_radius_m() > body.inscribed_radius_m() + kNearlyRound_m;
}

double ControlSetup::mover_radius_m() const {
  const Footprint& body = model.footprint;
  return std::min(body.circumscribed_radius_m(), body.inscribed_radius_m() + kMarginOverInscribed_m);
}

PlannerConfig ControlSetup::planner() const {
  PlannerConfig config;
  config.cell_m = kCell_m;
  config.side_cells = grid_side_for(start.position(), goal, kCell_m);
  config.body = model.footprint;
  config.keep_out = keep_out();
  config.known_map = known_map;
  return config;
}

motion::MotionSetup ControlSetup::motion() const {
  return {.model = model,
          .constant_speed = keeps_speed(),
          .steering = steering,
          .comfort_distance_m = comfort_distance_m,
          .goal_tolerance_m = goal_tolerance_m,
          .tick_s = to_seconds(tick()),
          .keep_out = keep_out()};
}

std::shared_ptr<const KeepOutField> ControlSetup::keep_out() const {
  const bool any =
      std::any_of(zones.begin(), zones.end(), [](const MapZone& z) { return z.kind == ZoneKind::kKeepOut; });
  return any ? std::make_shared<const KeepOutField>(zones) : nullptr;
}

const char* name_of(PlanMode mode) { return mode == PlanMode::kPaper ? "paper" : "full"; }

std::string to_text(const ControlSetup& setup) {
  nlohmann::json json(setup);
  if (!setup.model.laser.blanked.empty()) json["blanked"] = json_of(setup.model.laser.blanked);
  for (const LaserModel& laser : setup.model.other_lasers) json["other_lasers"].push_back(json_of(laser));
  json["drive_times"] = json_of(setup.model.drive.times);
  if (!setup.rival.empty()) json["planner"] = setup.rival;
  if (setup.given_movers) json["given_movers"] = true;
  if (setup.steering != StickUse::kNone) json["steering"] = setup.steering;
  json["berth_m"] = setup.comfort_distance_m;
  if (setup.unix_from_loop != Duration{0}) json["unix_from_loop_ns"] = setup.unix_from_loop.count();
  if (setup.part != 1) json["part"] = setup.part;
  if (!setup.zones.empty()) json["zones"] = setup.zones;
  if (setup.known_map) json["known_map"] = json_of(*setup.known_map);
  return json.dump();
}

ControlSetup setup_from_text(const std::string& text, const std::string& place) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    ControlSetup setup = json.get<ControlSetup>();
    setup.model.laser.blanked = blanked_of(json);
    for (const nlohmann::json& laser : json.value("other_lasers", nlohmann::json::array()))
      if (!setup.model.other_lasers.push_back(laser_of(laser))) throw std::invalid_argument("too many lasers");
    setup.model.drive.times = drive_times_of(json);
    setup.rival = json.value("planner", setup.rival);
    setup.given_movers = json.value("given_movers", false);
    setup.steering = json.value("steering", StickUse::kNone);
    setup.comfort_distance_m = json.at("berth_m").get<double>();
    setup.unix_from_loop = Duration{json.value("unix_from_loop_ns", std::int64_t{0})};
    setup.part = json.value("part", setup.part);
    setup.zones = json.value("zones", setup.zones);
    if (json.contains("known_map")) setup.known_map = known_map_of(json["known_map"]);
    return setup;
  } catch (const std::exception& error) {
    throw StartupError(place + ": not a controller's setup (" + error.what() + ")",
                       "give a recording that this program wrote");
  }
}

}  // namespace jaywalk
