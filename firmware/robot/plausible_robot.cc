#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "firmware/safety/blind_gaps.h"
#include "firmware/safety/stop_zone.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr double kOffBody_m = 0.3;      // a laser on a boom before a bumper; no farther
constexpr double kMostUnwatched = 0.2;  // of the way ahead, of a robot faster than SAFETY's 0.3 m/s
constexpr double kMostUnwatchedSlow = 0.5;
constexpr double kUnwatched_mps = 0.3;
constexpr double kWorn = 0.25;        // a wheel's or track's own measure is within this of the model's
constexpr double kUnlike = 0.1;       // and one wheel's of the other's
constexpr double kOverSide_m = 0.15;  // wheels stand out of a body by this at most
constexpr double kCountsATick = 2.0;  // at cruise: less says nothing of a wheel's speed
constexpr double kFastestMotor_rpm = 30000.0, kFastestField_rpm = 300000.0;  // no motor or controller is faster

struct Check {
  std::string place;
  void require(bool holds, const char* key, const std::string& cause, const char* remedy) const {
    if (!holds) throw StartupError(place + ": " + key + ": " + cause, remedy);
  }
};

void check_wheels(const Check& check, const RobotFile& robot, const DriveModel& nominal) {
  const RobotModel& model = robot.setup.model;
  const Footprint& body = model.footprint;
  const auto [left, right] = robot.drive.wheel_radii_m;
  for (const double radius : {left, right}) {
    check.require(std::fabs(radius / nominal.wheel_radius_m - 1.0) <= kWorn, "drive.left/right_wheel_radius_m",
                  formatted("is %.3g m, and the model's wheels have %.3g m", radius, nominal.wheel_radius_m),
                  "measure it (jaywalk calibrate); other wheels need a model file of their own");
  }
  check.require(std::fabs(left / right - 1.0) <= kUnlike, "drive.left_wheel_radius_m",
                formatted("is %.3g m, the right one's %.3g m", left, right), "measure both (jaywalk calibrate)");
  check.require(2.0 * nominal.wheel_radius_m <= body.front_m + body.rear_m, "model: drive.wheel_radius_m",
                formatted("a wheel of %.3g m across is longer than the body, %.3g m", 2.0 * nominal.wheel_radius_m,
                          body.front_m + body.rear_m),
                "give the radius, in metres, and the whole body as footprint");
  const double reached_mps = nominal.max_wheel_speed_radps * nominal.wheel_radius_m;
  check.require(reached_mps >= model.limits.max_speed_mps, "model: drive.max_wheel_speed_radps",
                formatted("times the wheel's radius of %.3g m is %.3g m/s, less than max_speed_mps %.3g",
                          nominal.wheel_radius_m, reached_mps, model.limits.max_speed_mps),
                "correct the wheel's radius or its fastest turning, or lower max_speed_mps");
  const double track = model.drive.track_width_m;
  check.require(std::fabs(track / nominal.track_width_m - 1.0) <= kWorn, "drive.track_width_m",
                formatted("is %.3g m, and the model's %.3g m", track, nominal.track_width_m),
                "measure it (jaywalk calibrate); another chassis needs a model file of its own");
  check.require(track <= 2.0 * (body.half_width_m + kOverSide_m), "drive.track_width_m",
                formatted("is %.3g m, wider than the body's %.3g m", track, 2.0 * body.half_width_m),
                "give the whole width as footprint, wheels included, or correct the track");
}

void check_gear(const Check& check, const RobotFile& robot, const DriveModel& nominal) {
  const RobotModel& model = robot.setup.model;
  const double cruise_radps = model.limits.max_speed_mps / nominal.wheel_radius_m;
  const auto [left, right] = robot.drive.axes();
  const double scale = std::max(std::fabs(left.per_rad), std::fabs(right.per_rad));  // of the faster scaled wheel
  const double fastest_rpm = scale * cruise_radps * 60.0;
  switch (robot.drive.kind) {
    case DriveKind::kCia402: {
      const double a_tick = scale * cruise_radps * to_seconds(robot.setup.tick());
      check.require(a_tick >= kCountsATick, "drive.counts_per_wheel_turn",
                    formatted("%.3g counts a turn are %.2g in a tick at max_speed_mps: too few to tell a speed by",
                              scale * 2.0 * kPi, a_tick),
                    "give encoder counts, all edges, times the gear");
      check.require(scale * nominal.max_wheel_speed_radps <= std::numeric_limits<std::int32_t>::max(),
                    "drive.counts_per_wheel_turn",
                    formatted("%.3g counts a turn are more a second than a drive counts", scale * 2.0 * kPi),
                    "give encoder counts, all edges, times the gear");
      return;
    }
    case DriveKind::kOdrive:
      return check.require(fastest_rpm <= kFastestMotor_rpm, "drive.motor_turns_per_wheel_turn",
                           formatted("its motors would turn %.0f times a minute at max_speed_mps", fastest_rpm),
                           "give the gear: turns of the motor for one of the wheel");
    case DriveKind::kVesc:
      return check.require(fastest_rpm <= kFastestField_rpm, "drive.electrical_turns_per_wheel_turn",
                           formatted("its field would turn %.0f times a minute at max_speed_mps", fastest_rpm),
                           "give the gear times the motor's pole pairs");
    case DriveKind::kDds:
    case DriveKind::kPioneer: return;
  }
}

/// A scan of which every beam is free.
std::unique_ptr<LaserScan> free_scan(const LaserModel& laser) {
  auto scan = std::make_unique<LaserScan>();
  scan->beam_count = laser.beams;
  scan->first_angle_rad = static_cast<float>(-0.5 * laser.fov_rad);
  scan->angle_step_rad = static_cast<float>(laser.fov_rad / (laser.beams - 1));
  scan->range_min_m = static_cast<float>(laser.range_min_m);
  scan->range_max_m = static_cast<float>(laser.range_max_m);
  scan->range_m.fill(std::numeric_limits<float>::infinity());
  return scan;
}

/// Share of the ground straight ahead, as far as the robot's longest stop, that no laser ever looks at.
double unwatched_ahead(const RobotFile& robot) {
  constexpr double kStep_m = 0.04;
  const RobotModel& model = robot.setup.model;
  std::vector<BlindGaps> gaps;
  for (const LaserModel& laser : model.lasers()) gaps.emplace_back(laser).update(*free_scan(laser));
  const OfEach<BlindGaps> seen{std::span<const BlindGaps>(gaps)};
  const double from_m = model.footprint.front_m + StopZoneConfig{}.margin_m;
  const double to_m = from_m + std::max(longest_stop_m(model, robot.setup.tick()), 0.5);
  double unwatched = 0.0, all = 0.0;
  for (double x = from_m; x <= to_m; x += kStep_m) {
    for (double y = -model.footprint.half_width_m; y <= model.footprint.half_width_m; y += kStep_m) {
      unwatched += coverage_at(seen, {x, y}) == Coverage::kUnwatched ? 1.0 : 0.0;
      all += 1.0;
    }
  }
  return unwatched / all;
}

void check_laser(const Check& check, const RobotFile& robot) {
  const RobotModel& model = robot.setup.model;
  for (const LaserModel& laser : model.lasers()) {
    const double off_m = model.footprint.distance_to(laser.robot_from_laser.position());
    check.require(off_m <= kOffBody_m, "laser.mount", formatted("the laser stands %.2g m off the body", off_m),
                  "give x and y from the drive axle's middle, in metres, or correct the footprint");
  }
  const double unwatched = unwatched_ahead(robot);
  const bool slow = model.limits.max_speed_mps <= kUnwatched_mps;
  check.require(unwatched <= (slow ? kMostUnwatchedSlow : kMostUnwatched), "laser.mount, fov_deg, blanked",
                formatted("the laser does not look at %.0f %% of the way ahead", 100.0 * unwatched),
                slow ? "correct mount (x, y, yaw), fov_deg and [[laser.blanked]]: it has to look where the robot drives"
                     : "correct mount (x, y, yaw), fov_deg and [[laser.blanked]]; for up to half of the way, set "
                       "max_speed_mps = 0.3");
}

}  // namespace

void require_plausible(const RobotFile& robot, const DriveModel& nominal, const std::string& place) {
  const Check check{place};
  check_wheels(check, robot, nominal);
  check_gear(check, robot, nominal);
  check_laser(check, robot);
}

}  // namespace jaywalk
