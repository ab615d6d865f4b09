#include "firmware/safety/zone_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "firmware/safety/reaction.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr double kPost_m = 0.07;
constexpr const char* kRemedy = ", raise limits.brake_mps2 (what the drives are proved to do), or take ";

/// From the laser to the farthest corner of the footprint.
double farthest_corner_m(const Footprint& body, const LaserModel& of) {
  const Vec2 laser = of.robot_from_laser.position();
  double farthest = 0.0;
  for (const double x : {body.front_m, -body.rear_m}) {
    for (const double y : {body.half_width_m, -body.half_width_m})
      farthest = std::max(farthest, distance(laser, {x, y}));
  }
  return farthest;
}

}  // namespace

double fastest_rim_mps(const RobotModel& model) noexcept {
  return model.limits.max_speed_mps + model.limits.max_turn_radps * model.footprint.circumscribed_radius_m();
}

double longest_stop_m(const RobotModel& model, Duration tick) noexcept {
  const double v = fastest_rim_mps(model);
  return v * worst_reaction_s(model, tick) + v * v / (2.0 * model.limits.brake_mps2);
}

StopZoneConfig stop_zone_for(const RobotModel& model, Duration tick) noexcept {
  OfOthers<Pose2> others;
  for (const LaserModel& laser : model.other_lasers) (void)others.push_back(laser.robot_from_laser);
  return {.footprint = model.footprint,
          .robot_from_laser = model.laser.robot_from_laser,
          .brake_mps2 = model.limits.brake_mps2,
          .look_ahead_m = std::min(longest_stop_m(model, tick), SweptPath::kLongest_m),
          .robot_from_others = others};
}

namespace {

/// Fastest speed ahead (m/s) whose stop takes no more than `stop_m`, at the model's turn rate.
double speed_for_stop(const RobotModel& model, Duration tick, double stop_m) {
  const double bt = model.limits.brake_mps2 * worst_reaction_s(model, tick);
  const double rim_mps = std::sqrt(bt * bt + 2.0 * model.limits.brake_mps2 * std::max(stop_m, 0.0)) - bt;
  return model.limits.max_speed_mps - (fastest_rim_mps(model) - rim_mps);
}

std::string lower_speed_to(double mps) {
  std::array<char, 60> text{};
  std::snprintf(text.data(), text.size(), "lower limits.max_speed_mps to %.2f", std::floor(100.0 * mps) / 100.0);
  return mps >= 0.01 ? text.data() : "lower limits.max_speed_mps and max_turn_radps";
}

void require_in_reach(const RobotModel& model, const LaserModel& laser, Duration tick, const std::string& place) {
  const double stop_m = longest_stop_m(model, tick);
  const double reach_m = stop_m + StopZoneConfig{}.margin_m + farthest_corner_m(model.footprint, laser);
  const double step_rad = laser.fov_rad / (laser.beams - 1);
  const double seen_m = kPost_m / (2.0 * sin(std::min(0.5 * step_rad, 0.5 * kPi)));
  std::array<char, 200> text{};
  const auto refuse_beyond = [&](double limit_m, const char* why, const char* otherwise) {
    if (reach_m <= limit_m) return;
    std::snprintf(text.data(), text.size(), ": stopping takes %.1f m, up to %.1f m from the laser, and %s %.1f m",
                  stop_m, reach_m, why, limit_m);
    throw StartupError(place + text.data(),
                       lower_speed_to(speed_for_stop(model, tick, stop_m - (reach_m - limit_m))) + kRemedy + otherwise);
  };
  refuse_beyond(laser.range_max_m, "its range is", "a laser that sees farther");
  refuse_beyond(seen_m, "a post of 70 mm fits between two of its beams from", "a laser with more beams");
  refuse_beyond(SweptPath::kLongest_m, "the stop zone ends at", "a slower robot");
}

}  // namespace

void require_zone_in_reach(const RobotModel& model, Duration tick, const std::string& place) {
  for (const LaserModel& laser : model.lasers()) require_in_reach(model, laser, tick, place);
}

}  // namespace jaywalk
