#include "hal/sim/sensors.h"

#include <algorithm>
#include <limits>

namespace jaywalk::sim {
namespace {

/// As a scanner does whose packets of a sector are lost, or whose window is dirty there.
void lose(const BlankedSector& sector, LaserScan& scan) noexcept {
  constexpr double kSame_rad = 1e-6;  // single precision's angles: a beam on the sector's rim is in it
  for (std::size_t k = 0; k < scan.beam_count; ++k) {
    if (sector.off_rad(scan.angle_rad(k)) <= kSame_rad) scan.range_m[k] = 0.0F;
  }
}

LaserModel true_laser(const Scenario& scenario) {
  LaserModel laser = scenario.model.laser;
  laser.robot_from_laser = scenario.truth.robot_from_laser.value_or(laser.robot_from_laser);
  return laser;
}

}  // namespace

bool Metronome::due(Time now) noexcept {
  const bool is_due = now >= time_from_seconds(beats_ / rate_hz_);
  if (is_due) beats_ += 1.0;
  return is_due;
}

Sensors::Sensors(const Scenario& scenario, std::uint64_t seed)
    : pose_source_(scenario.pose_source),
      laser_beat_(scenario.model.laser.rate_hz),
      encoder_beat_(1.0 / to_seconds(kEncoderPeriod)),
      fix_beat_(scenario.pose_source.rate_hz),
      laser_(true_laser(scenario), seed),
      laser_turns_(scenario.laser_turns),
      fix_noise_(seed, Purpose::kFix) {}

void Sensors::sense(World& world) noexcept {
  const Time now = world.now();
  const bool silent = world.fault_active(FaultKind::kScanStale);
  turning_ = turning_ && !silent;
  if (turning_) turn(world);
  if (laser_beat_.due(now) && !silent) look(world);
  if (encoder_beat_.due(now) && !world.fault_active(FaultKind::kWheelsStale)) {
    wheels_ = world.plant().read_encoders(now);
  }
  if (fix_beat_.due(now) && pose_source_.enabled) locate(world.truth());
}

void Sensors::look(const World& world) noexcept {
  const Truth& truth = world.truth();
  if (world.fault_active(FaultKind::kScanFrozen)) {
    ++scan_.sequence;
    scan_.stamp = truth.now;
    return;
  }
  if (laser_turns_) {
    laser_.begin_turn(truth.now);
    turning_ = true;
    turn(world);
    return;
  }
  ++scan_.sequence;
  laser_.sweep(world.walls(), world.movers_seen(), truth.map_from_robot, truth.now, scan_);
  spoil(world);
}

void Sensors::turn(const World& world) noexcept {
  const Truth& truth = world.truth();
  if (!laser_.turn(world.walls(), world.movers_seen(), truth.map_from_robot, truth.now, scan_)) return;
  turning_ = false;
  ++scan_.sequence;
  spoil(world);
}

void Sensors::spoil(const World& world) noexcept {
  if (world.fault_active(FaultKind::kScanNan)) scan_.range_m.fill(std::numeric_limits<float>::quiet_NaN());
  if (world.fault_active(FaultKind::kScanShort)) scan_.beam_count /= 2;
  for (const FaultSpec& fault : world.faults()) {
    if (fault.kind == FaultKind::kBeamsLost && fault.active(to_seconds(world.now()))) lose(fault.lost, scan_);
  }
  if (world.fault_active(FaultKind::kScannerMirrored))
    std::reverse(scan_.range_m.begin(), scan_.range_m.begin() + scan_.beam_count);
}

void Sensors::locate(const Truth& truth) noexcept {
  const auto noisy = [&](Vec2 p, double std_m) {
    const double x = fix_noise_.normal(), y = fix_noise_.normal();
    return p + Vec2{x, y} * std_m;
  };
  const Vec2 position = noisy(truth.map_from_robot.position(), pose_source_.position_std_m);
  const double turned = pose_source_.heading_std_rad * fix_noise_.normal();
  fix_.stamp = truth.now;
  ++fix_.sequence;
  fix_.has_pose = true;
  fix_.map_from_robot = {position.x, position.y, wrap_angle(truth.map_from_robot.heading + turned)};
  fix_.position_std_m = pose_source_.position_std_m;
  fix_.heading_std_rad = pose_source_.heading_std_rad;
  fix_.mover_std_m = pose_source_.mover_std_m;
  fix_.movers.clear();
  for (const MoverTruth& mover : truth.movers) {  // those beyond kMaxObservedMovers have no tag to be seen by
    if (!fix_.movers.push_back({mover.id, noisy(mover.position, pose_source_.mover_std_m), mover.radius_m})) break;
  }
}

}  // namespace jaywalk::sim
