#include "tools/rig/plant/simulated_robot.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::rig {
namespace {

constexpr Duration kEncoderPeriod = std::chrono::milliseconds(10);

SocketCan place_on(const std::string& interface, Clock& clock) {
  const std::array all{CanFilter{}};
  return {open_can(interface, all), clock};
}

emulators::SickModel scanner_model(const LaserModel& laser) {
  constexpr double kTdegPerRad = 1.8e6 / kPi, kAhead = 900000.0;
  return {.beams = laser.beams,
          .first_angle_tdeg = static_cast<std::int32_t>(kAhead - 0.5 * laser.fov_rad * kTdegPerRad),
          .step_tdeg = static_cast<std::uint16_t>(laser.fov_rad / (laser.beams - 1) * kTdegPerRad),
          .rate_hz = laser.rate_hz,
          .range_max_m = laser.range_max_m};
}

}  // namespace

SimulatedRobot::SimulatedRobot(const sim::Scenario& scenario, std::uint64_t seed, const PlantWiring& wiring,
                               Clock& clock)
    : clock_(clock),
      began_(clock.now()),
      world_(scenario, seed),
      laser_(scenario.model.laser),
      wheel_radius_m_(scenario.model.drive.wheel_radius_m),
      noise_(seed, sim::Purpose::kRange),
      counts_per_rad_{wiring.counts_per_wheel_turn / (2.0 * kPi),
                      (wiring.right_reversed ? -1.0 : 1.0) * wiring.counts_per_wheel_turn / (2.0 * kPi)},
      left_socket_(place_on(wiring.can, clock)),
      right_socket_(place_on(wiring.can, clock)),
      left_(left_socket_, wiring.nodes[0]),
      right_(right_socket_, wiring.nodes[1]),
      scanner_(std::make_unique<emulators::TcpServer>(wiring.scanner_port), scanner_model(laser_),
               [this](std::size_t first, std::span<float> range_m) { look(first, range_m); }) {}

void SimulatedRobot::step() {
  const Time now = clock_.now();
  left_.step(now);
  right_.step(now);
  while (world_.now() + (began_.time_since_epoch()) < now) {
    turn_wheels();
    world_.step();
  }
  scanner_.step(now);
}

void SimulatedRobot::turn_wheels() {
  world_.plant().command({world_.now(), wheel_speed(0), wheel_speed(1)}, world_.now());
  if (age(encoders_read_, world_.now()) < kEncoderPeriod) return;
  encoders_read_ = world_.now();
  const WheelState wheels = world_.plant().read_encoders(world_.now());
  left_.measure(wheels.left_radps * counts_per_rad_[0], wheels.left_rad * counts_per_rad_[0]);
  right_.measure(wheels.right_radps * counts_per_rad_[1], wheels.right_rad * counts_per_rad_[1]);
}

double SimulatedRobot::wheel_speed(std::size_t side) const noexcept {
  return (side == 0 ? left_ : right_).velocity() / counts_per_rad_[side];
}

double SimulatedRobot::rim_speed() const noexcept {
  return std::max(std::fabs(wheel_speed(0)), std::fabs(wheel_speed(1))) * wheel_radius_m_;
}

CanHealth SimulatedRobot::bus_health() const noexcept {
  CanHealth both = left_socket_.health();
  const CanHealth right = right_socket_.health();
  both.frames_lost = std::max(both.frames_lost, right.frames_lost);
  both.malformed = std::max(both.malformed, right.malformed);
  both.error_frames = std::max(both.error_frames, right.error_frames);
  both.state = std::max(both.state, right.state);
  return both;
}

/// As hal/sim's laser does it, beam by beam as the mirror turns.
void SimulatedRobot::look(std::size_t first_beam, std::span<float> range_m) {
  const Pose2 map_from_laser = truth().map_from_robot * laser_.robot_from_laser;
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const double angle = scanner_.shape().angle_rad(first_beam + k);
    const Vec2 beam = direction(map_from_laser.heading + angle);
    double range = world_.walls().cast(map_from_laser.position(), beam, laser_.range_max_m);
    for (const sim::Disc& body : world_.bodies())
      range = std::min(range, hit_range(map_from_laser.position(), beam, body));
    range += laser_.noise_m * noise_.normal();
    range_m[k] = range >= laser_.range_min_m && range <= laser_.range_max_m ? static_cast<float>(range) : 0.0F;
  }
}

}  // namespace jaywalk::rig
