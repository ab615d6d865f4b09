#include "firmware/control_setup.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "hal/types/errors.h"

namespace jaywalk::baseline {
NLOHMANN_JSON_SERIALIZE_ENUM(Baseline, {{Baseline::kOurs, "ours"},
                                        {Baseline::kNone, "none"},
                                        {Baseline::kReplan, "replan"},
                                        {Baseline::kDwa, "dwa"},
                                        {Baseline::kOrca, "orca"}})
}  // namespace jaywalk::baseline

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
                                   wheels, wired, rate_hz)

namespace {

constexpr double kCell_m = 0.1;  // the paper's
/// What a robot that is nearly round may plan with beyond the circle inside it.
constexpr double kMarginOverInscribed_m = 0.15;
const double kMoverMargin_m = PlannerConfig{}.mover_margin_m;

}  // namespace

bool ControlSetup::guides_body() const {
  const Footprint& body = model.footprint;
  return !keeps_speed() && body.circumscribed_radius_m() > body.inscribed_radius_m() + kMarginOverInscribed_m;
}

double ControlSetup::mover_radius_m() const {
  const Footprint& body = model.footprint;
  return std::min(body.circumscribed_radius_m(), body.inscribed_radius_m() + kMarginOverInscribed_m);
}

PlannerConfig ControlSetup::planner() const {
  PlannerConfig config;
  config.mode = mode;
  config.cell_m = kCell_m;
  config.side_cells = grid_side_for(start.position(), goal, kCell_m);
  config.inscribed_m = model.footprint.inscribed_radius_m();
  config.circumscribed_m = model.footprint.circumscribed_radius_m();
  config.inflation_m = guides_body() ? model.footprint.inscribed_radius_m() : mover_radius_m();
  config.mover_margin_m = kMoverMargin_m + mover_radius_m() - config.inflation_m;
  config.keep_out = keep_out();
  return config;
}

std::shared_ptr<const KeepOutField> ControlSetup::keep_out() const {
  const bool any =
      std::any_of(zones.begin(), zones.end(), [](const MapZone& z) { return z.kind == ZoneKind::kKeepOut; });
  return any ? std::make_shared<const KeepOutField>(zones) : nullptr;
}

const char* name_of(PlanMode mode) { return mode == PlanMode::kPaper ? "paper" : "full"; }

std::string name_of(baseline::Baseline which) { return nlohmann::json(which).get<std::string>(); }

std::string to_text(const ControlSetup& setup) {
  nlohmann::json json(setup);
  // Not one of the fields above: setups that were written before it was one say nothing of it.
  for (const BlankedSector& sector : setup.model.laser.blanked)
    json["blanked"].push_back({sector.from_rad, sector.to_rad});
  json["judges_motion"] = setup.judges_motion;
  if (setup.baseline != baseline::Baseline::kOurs) json["planner"] = setup.baseline;
  if (setup.given_movers) json["given_movers"] = true;
  if (setup.steering != StickUse::kNone) json["steering"] = setup.steering;
  json["berth_m"] = setup.berth_m;
  if (!setup.zones.empty()) json["zones"] = setup.zones;
  return json.dump();
}

ControlSetup setup_from_text(const std::string& text, const std::string& place) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    ControlSetup setup = json.get<ControlSetup>();
    for (const auto& [from, to] : json.value("blanked", std::vector<std::array<double, 2>>{}))
      (void)setup.model.laser.blanked.push_back({from, to});  // no more than were written
    setup.judges_motion = json.value("judges_motion", false);
    setup.baseline = json.value("planner", baseline::Baseline::kOurs);
    setup.given_movers = json.value("given_movers", false);
    setup.steering = json.value("steering", StickUse::kNone);
    setup.berth_m = json.value("berth_m", setup.berth_m);
    setup.zones = json.value("zones", setup.zones);
    return setup;
  } catch (const nlohmann::json::exception& error) {
    throw StartupError(place + ": not a controller's setup (" + error.what() + ")",
                       "give a recording that this program wrote");
  }
}

}  // namespace jaywalk
