#include "hal/types/robot_model.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kSame_rad = 1e-6;  // single precision's angles: a beam on a sector's rim is in it

/// Counter-clockwise from one direction to the other, in [0, 2 pi).
double turn_between(double from_rad, double to_rad) {
  const double turn = wrap_angle(to_rad - from_rad);
  return turn < 0.0 ? turn + 2.0 * kPi : turn;
}

/// Of a corner: by its end of the body.
const char* side_of(const Footprint& body, Vec2 mount) {
  const double half_length_m = 0.5 * (body.front_m + body.rear_m);
  const double ahead = (mount.x - (body.front_m - half_length_m)) / half_length_m;
  const double left = mount.y / body.half_width_m;
  if (std::fabs(ahead) < 0.5 * std::fabs(left)) return left > 0.0 ? "left" : "right";
  return ahead < 0.0 ? "rear" : "front";
}

}  // namespace

double BlankedSector::width_rad() const noexcept { return turn_between(from_rad, to_rad); }

double BlankedSector::off_rad(double direction_rad) const noexcept {
  const double past_from = turn_between(from_rad, direction_rad), width = width_rad();
  if (past_from <= width) return 0.0;
  return std::min(past_from - width, 2.0 * kPi - past_from);
}

void blank(std::span<const BlankedSector> sectors, LaserScan& scan, float says_m) noexcept {
  if (sectors.empty()) return;
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  for (std::size_t k = 0; k < beams; ++k) {
    const double angle = scan.angle_rad(k);
    const bool own = std::any_of(sectors.begin(), sectors.end(),
                                 [&](const BlankedSector& sector) { return sector.off_rad(angle) <= kSame_rad; });
    if (own) scan.range_m[k] = says_m;
  }
}

std::string scanner_name(const RobotModel& model, std::size_t scanner) {
  if (model.other_lasers.empty()) return "";
  const auto side = [&](std::size_t k) {
    return std::string(side_of(model.footprint, model.lasers()[k].robot_from_laser.position()));
  };
  const std::string name = side(scanner);
  int number = 1;
  for (std::size_t k = 0; k < scanner; ++k) number += side(k) == name ? 1 : 0;
  return number == 1 ? name : name + std::to_string(number);
}

// ARIA: params/p3dx.p of the maker's library (github.com/reedhedges/AriaCoda). A number without a source is assumed,
// with the reason why it errs on the safe side or does not matter to safety.
RobotModel p3dx() {
  return {.name = "p3dx",
          .footprint = {.front_m = 0.210,         // ARIA: RobotLengthFront
                        .rear_m = 0.301,          // ARIA: RobotLengthRear, the caster's housing
                        .half_width_m = 0.2125},  // ARIA: RobotWidth 425, over the wheels
          .drive = {.wheel_radius_m = 0.0975,     // data sheet: 195 mm across
                    .track_width_m = 0.33,        // assumed: wheels of 5 cm within 0.381 m; calibrate measures it
                    // Assumed: the data sheet's 1.2 m/s and a bend's outer wheel. Bounds what odometry may report; a
                    // motor that cannot is told by wheels_disobey.
                    .max_wheel_speed_radps = 14.0},
          .limits = {.max_speed_mps = 0.6,          // ours: half of the data sheet's 1.2
                     .max_turn_radps = 1.5,         // ours: data sheet 5.2 (300 degrees/s)
                     .max_accel_mps2 = 0.5,         // ours: comfort, half of the braking
                     .max_turn_accel_radps2 = 3.0,  // ours: comfort, 0.5 m/s2 at a wheel
                     .max_jerk_mps3 = 2.0,          // ours: comfort
                     // ODrives' ramp (vel_ramp_rate, docs/reference/hardware.md) in place of the base's own board,
                     // whose TransDecel is 0.3 from the factory (Pioneer 3 Operations Manual).
                     .brake_mps2 = 1.0},
          .laser = {.robot_from_laser = {0.0, 0.0, 0.0},  // ours: robot files give their own
                    .fov_rad = 270.0 * kPi / 180.0,  // SICK TiM571, data sheet: 270 degrees in steps of 1/3, 15 Hz,
                    .beams = 811,                    // 0.05 to 25 m
                    .rate_hz = 15.0,
                    .range_min_m = 0.05,
                    .range_max_m = 25.0,
                    .noise_m = 0.01,  // assumed for the simulation: the data sheet's statistical error is 20 mm at most
                    .drop_out = 0.0}};
}

RobotModel wheelchair() {
  RobotModel model = p3dx();
  model.name = "wheelchair";
  // Assumed, of no make: EN 12184 allows 0.70 m x 1.20 m and 5 cm of feet. On the safe side only of a chair that is no
  // larger, so that deploy/config says: measure yours.
  model.footprint = {.front_m = 0.75, .rear_m = 0.35, .half_width_m = 0.325};
  model.drive = {.wheel_radius_m = 0.17,          // assumed: 14 inches, under load; calibrate measures it
                 .track_width_m = 0.56,           // assumed; calibrate measures it
                 .max_wheel_speed_radps = 16.0};  // assumed: 2.7 m/s, 10 km/h; bounds what odometry may report
  model.limits.max_turn_radps = 1.0;              // ours: comfort
  model.limits.max_turn_accel_radps2 = 2.0;       // ours: comfort
  // brake_mps2 as above: EN 12184 has a chair stop within 1.0 m from 6 km/h, with 1.4 m/s2.
  model.laser.robot_from_laser = {0.70, 0.0, 0.0};  // assumed: between the footrests
  return model;
}

}  // namespace jaywalk
