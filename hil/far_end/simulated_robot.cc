#include "hil/far_end/simulated_robot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace jaywalk::rig {
namespace {

constexpr Duration kEncoderPeriod = std::chrono::milliseconds(10);

/// Shaped as the controller believes, and mounted so where the scenario has no truth about it; as noisy as that says.
LaserModel laser_of(const sim::Scenario& scenario, const RobotFile& wiring) {
  LaserModel laser = wiring.setup.model.laser;
  laser.robot_from_laser = scenario.truth.robot_from_laser.value_or(laser.robot_from_laser);
  laser.noise_m = scenario.model.laser.noise_m;
  return laser;
}

}  // namespace

SimulatedRobot::SimulatedRobot(const sim::Scenario& scenario, std::uint64_t seed, const RobotFile& wiring,
                               const Buses& buses, std::unique_ptr<emulators::ByteServer> wire, Time now)
    : began_(now),
      world_(scenario, seed),
      laser_(laser_of(scenario, wiring)),
      wheel_radius_m_(scenario.model.drive.wheel_radius_m),
      noise_(seed, sim::Purpose::kRange),
      buses_(buses),
      drives_{make_wheel_drive(wiring.drive, 0, *buses[0]), make_wheel_drive(wiring.drive, 1, *buses[1])},
      scanner_(make_far_scanner(wiring.laser, laser_, std::move(wire),
                                [this](std::size_t first, std::span<float> range_m) { look(first, range_m); })) {}

void SimulatedRobot::step(Time now) {
  for (const auto& drive : drives_) drive->step(now);
  while (world_.now() + (began_.time_since_epoch()) < now) {
    turn_wheels();
    world_.step();
  }
  scanner_->step(now);
}

void SimulatedRobot::turn_wheels() {
  world_.plant().command({world_.now(), drives_[0]->speed_radps(), drives_[1]->speed_radps()}, world_.now());
  if (age(encoders_read_, world_.now()) < kEncoderPeriod) return;
  encoders_read_ = world_.now();
  const WheelState wheels = world_.plant().read_encoders(world_.now());
  if (!senses_.counters_stand) counted_rad_ = {wheels.left_rad, wheels.right_rad};
  drives_[0]->measure(wheels.left_radps, counted_rad_[0]);
  drives_[1]->measure(wheels.right_radps, counted_rad_[1]);
}

double SimulatedRobot::rim_speed() const noexcept {
  return std::max(std::fabs(drives_[0]->speed_radps()), std::fabs(drives_[1]->speed_radps())) * wheel_radius_m_;
}

CanHealth SimulatedRobot::bus_health() const noexcept {
  CanHealth both = buses_[0]->health();
  const CanHealth right = buses_[1]->health();
  both.frames_lost = std::max(both.frames_lost, right.frames_lost);
  both.malformed = std::max(both.malformed, right.malformed);
  both.error_frames = std::max(both.error_frames, right.error_frames);
  both.state = std::max(both.state, right.state);
  return both;
}

/// As hal/sim's laser does it, beam by beam as the mirror turns.
void SimulatedRobot::look(std::size_t first_beam, std::span<float> range_m) {
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const double range = range_along(first_beam + k) + laser_.noise_m * noise_.normal();
    range_m[k] = range < laser_.range_min_m   ? 0.0F
                 : range > laser_.range_max_m ? std::numeric_limits<float>::infinity()
                                              : static_cast<float>(range);
  }
}

double SimulatedRobot::range_along(std::size_t beam) {
  const double looked = scanner_->shape().angle_rad(beam);
  double& range = last_range_m_[std::min(beam, kMaxBeams - 1)];
  if (looked > senses_.repeats.from_rad && looked < senses_.repeats.to_rad) return range;
  const Pose2 map_from_laser = truth().map_from_robot * laser_.robot_from_laser;
  const double angle = world_.fault_active(sim::FaultKind::kScannerMirrored) ? -looked : looked;
  const Vec2 towards = direction(map_from_laser.heading + senses_.mount_turned_rad + angle);
  range = world_.walls().cast(map_from_laser.position(), towards, laser_.range_max_m);
  for (const sim::Disc& body : world_.movers_seen())
    range = std::min(range, hit_range(map_from_laser.position(), towards, body));
  return range;
}

}  // namespace jaywalk::rig
