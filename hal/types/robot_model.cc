#include "hal/types/robot_model.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

double Footprint::inscribed_radius_m() const { return std::min({front_m, rear_m, half_width_m}); }

double Footprint::circumscribed_radius_m() const { return norm({std::max(front_m, rear_m), half_width_m}); }

double Footprint::distance_to(Vec2 p) const {
  const double beyond_x = std::max({p.x - front_m, -rear_m - p.x, 0.0});
  const double beyond_y = std::max(std::fabs(p.y) - half_width_m, 0.0);
  return norm({beyond_x, beyond_y});
}

double DriveTimes::oldest_report_s() const { return 2.0 * report_s + std::max(late_s, 0.5 * report_s); }

double DriveTimes::obeyed_within_s() const {
  constexpr double kTickAndBus_s = 0.13;  // two ticks of 20 Hz and a frame that waits for others
  return kTickAndBus_s + response_s + report_s + late_s;
}

double DriveTimes::slower_s(double tick_s) const {
  const DriveTimes usual;
  return std::max(response_s - usual.response_s, 0.0) + std::max(report_s - std::max(usual.report_s, tick_s), 0.0) +
         late_s;
}

namespace {

/// Of a corner: by its end of the body.
const char* side_of(const Footprint& body, Vec2 mount) {
  const double half_length_m = 0.5 * (body.front_m + body.rear_m);
  const double ahead = (mount.x - (body.front_m - half_length_m)) / half_length_m;
  const double left = mount.y / body.half_width_m;
  if (std::fabs(ahead) < 0.5 * std::fabs(left)) return left > 0.0 ? "left" : "right";
  return ahead < 0.0 ? "rear" : "front";
}

}  // namespace

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

RobotModel p3dx() {
  return {.name = "p3dx",
          .footprint = {.front_m = 0.2275, .rear_m = 0.2275, .half_width_m = 0.1905},
          .drive = {.wheel_radius_m = 0.0975, .track_width_m = 0.33, .max_wheel_speed_radps = 14.0},
          .limits = {.max_speed_mps = 0.6,
                     .max_turn_radps = 1.5,
                     .max_accel_mps2 = 0.5,
                     .max_turn_accel_radps2 = 3.0,
                     .max_jerk_mps3 = 2.0,
                     .brake_mps2 = 1.0},
          .laser = {.robot_from_laser = {0.0, 0.0, 0.0},
                    .fov_rad = 270.0 * kPi / 180.0,
                    .beams = 811,
                    .rate_hz = 15.0,
                    .range_min_m = 0.05,
                    .range_max_m = 25.0,
                    .noise_m = 0.01,
                    .drop_out = 0.0}};
}

RobotModel wheelchair() {
  RobotModel model = p3dx();
  model.name = "wheelchair";
  model.footprint = {.front_m = 0.75, .rear_m = 0.35, .half_width_m = 0.325};
  model.drive = {.wheel_radius_m = 0.17, .track_width_m = 0.56, .max_wheel_speed_radps = 16.0};
  model.limits.max_turn_radps = 1.0;
  model.limits.max_turn_accel_radps2 = 2.0;
  model.laser.robot_from_laser = {0.70, 0.0, 0.0};
  return model;
}

}  // namespace jaywalk
