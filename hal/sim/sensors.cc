#include "hal/sim/sensors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "hal/shown_text.h"
#include "hal/sim/simulation.h"
#include "hal/text_file.h"
#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

/// Drops before the window: each beam by itself, in each scan anew.
void rain_on(LaserScan& scan, Random& random) noexcept {
  constexpr double kShare = 0.005, kNearest_m = 0.1, kFarthest_m = 0.3;
  for (std::size_t k = 0; k < scan.beam_count; ++k)
    if (random.uniform() < kShare) scan.range_m[k] = static_cast<float>(random.uniform(kNearest_m, kFarthest_m));
}

LaserModel true_laser(const Scenario& scenario, std::size_t scanner) {
  LaserModel laser = scenario.model.lasers()[scanner];
  if (scanner == 0) laser.robot_from_laser = scenario.truth.robot_from_laser.value_or(laser.robot_from_laser);
  return laser;
}

constexpr double kTremble_s = 0.5;   ///< correlation time of a hand
constexpr double kLeftPerRad = 1.2;  ///< of the stick's way, a radian off the goal
constexpr double kTurnsFirst_rad = 1.0;
constexpr double kArrived = 0.5;  ///< of the goal's tolerance: then the hand lets go
constexpr std::size_t kRemembered = 1024;
constexpr const char* kStickRows =
    "write rows of t_s,forward,left below a line that says so; forward and left -1 to 1, times rising";

}  // namespace

LaserSim::LaserSim(const LaserModel& model, std::uint64_t seed, std::uint64_t index)
    : model_(model),
      in_laser_(model.beams),
      in_map_(model.beams),
      range_(model.beams),
      noise_(seed, Purpose::kRange, index),
      loss_(seed, Purpose::kDropOut, index) {
  const double step = model.fov_rad / (model.beams - 1);
  for (std::size_t k = 0; k < in_laser_.size(); ++k)
    in_laser_[k] = direction(-0.5 * model.fov_rad + static_cast<double>(k) * step);
}

bool LaserSim::turn(const Walls& walls, std::span<const Disc> movers, const Pose2& map_from_robot, Time now,
                    LaserScan& scan) noexcept {
  if (measured_ == range_.size()) return false;
  const Pose2 map_from_laser = map_from_robot * model_.robot_from_laser;
  const Transform2 to_map(map_from_laser);
  const Vec2 laser = map_from_laser.position();
  const double gone = model_.turns ? std::min(1.0, to_seconds(now - began_) / to_seconds(turn_takes())) : 1.0;
  const auto due = static_cast<std::size_t>(gone * static_cast<double>(range_.size() - 1)) + 1;
  for (std::size_t k = measured_; k < due; ++k) {
    in_map_[k] = to_map.rotate(in_laser_[k]);
    range_[k] = walls.cast(laser, in_map_[k], model_.range_max_m);
  }
  for (const Disc& mover : movers) {
    if (!model_.turns && distance(laser, mover.centre) - mover.radius_m > model_.range_max_m) continue;
    for (std::size_t k = measured_; k < due; ++k) range_[k] = std::min(range_[k], hit_range(laser, in_map_[k], mover));
  }
  measured_ = std::max(measured_, due);
  const bool complete = measured_ == range_.size();
  if (complete) write(scan);
  return complete;
}

void LaserSim::write(LaserScan& scan) noexcept {
  scan.stamp = began_;
  scan.beam_count = model_.beams;
  scan.first_angle_rad = static_cast<float>(-0.5 * model_.fov_rad);
  scan.angle_step_rad = static_cast<float>(model_.fov_rad / (model_.beams - 1));
  scan.range_min_m = static_cast<float>(model_.range_min_m);
  scan.range_max_m = static_cast<float>(model_.range_max_m);
  scan.sweep = turn_takes();
  scan.period = duration_from_seconds(1.0 / model_.rate_hz);
  for (std::size_t k = 0; k < range_.size(); ++k) scan.range_m[k] = measured(range_[k]);
}

Sensors::Sensors(const Scenario& scenario, std::uint64_t seed)
    : reports_(scenario.reports),
      pose_source_(scenario.pose_source),
      encoder_beat_(1.0 / scenario.reports.period_s),
      fix_beat_(scenario.pose_source.rate_hz),
      fix_noise_(seed, Purpose::kFix),
      delay_(seed, Purpose::kDelay) {
  const std::size_t count = scenario.model.lasers().size();
  for (std::size_t k = 0; k < count; ++k) {
    const LaserModel laser = true_laser(scenario, k);
    const double phase = static_cast<double>(k) / static_cast<double>(count);  // no clock of theirs is another's
    scanners_.push_back(
        {k, Metronome(laser.rate_hz, phase), LaserSim(laser, seed, k), Random(seed, Purpose::kRain, k)});
  }
}

void Sensors::sense(World& world) noexcept {
  const Time now = world.now();
  for (Scanner& scanner : scanners_) sense(scanner, world);
  if (encoder_beat_.due(now) && !world.fault_active(FaultKind::kWheelsStale)) report(world);
  deliver_reports(now);
  if (fix_beat_.due(now) && pose_source_.enabled) locate(world.truth());
}

void Sensors::sense(Scanner& scanner, const World& world) noexcept {
  const bool silent = world.fault_active(FaultKind::kScanStale, scanner.index);
  scanner.turning = scanner.turning && !silent;
  if (scanner.turning) turn(scanner, world);
  if (scanner.beat.due(world.now()) && !silent) look(scanner, world);
}

void Sensors::look(Scanner& scanner, const World& world) noexcept {
  const Truth& truth = world.truth();
  if (world.fault_active(FaultKind::kScanFrozen, scanner.index)) {
    ++scanner.scan.sequence;
    scanner.scan.stamp = truth.now;
    return;
  }
  scanner.laser.begin_turn(truth.now);
  scanner.turning = true;
  turn(scanner, world);
}

void Sensors::turn(Scanner& scanner, const World& world) noexcept {
  const Truth& truth = world.truth();
  if (!scanner.laser.turn(world.walls(), world.movers_seen(), truth.map_from_robot, truth.now, scanner.scan)) return;
  scanner.turning = false;
  ++scanner.scan.sequence;
  spoil(scanner, world);
}

void Sensors::spoil(Scanner& scanner, const World& world) noexcept {
  LaserScan& scan = scanner.scan;
  const auto has = [&](FaultKind kind) { return world.fault_active(kind, scanner.index); };
  if (has(FaultKind::kScanNan)) scan.range_m.fill(std::numeric_limits<float>::quiet_NaN());
  if (has(FaultKind::kScanShort)) scan.beam_count /= 2;
  for (const FaultSpec& fault : world.faults()) {
    const bool active = fault.is_of(scanner.index) && fault.active(to_seconds(world.now()));
    if (fault.kind == FaultKind::kBeamsLost && active)
      blank({&fault.lost, 1}, scan, fault.claims_free ? std::numeric_limits<float>::infinity() : 0.0F);
  }
  if (has(FaultKind::kRain)) rain_on(scan, scanner.rain);
  if (has(FaultKind::kScannerMirrored)) std::reverse(scan.range_m.begin(), scan.range_m.begin() + scan.beam_count);
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
  for (const MoverTruth& mover : truth.movers)  // those beyond kMaxObservedMovers have no tag to be seen by
    if (!fix_.movers.push_back({mover.id, noisy(mover.position, pose_source_.mover_std_m), mover.radius_m})) break;
}

ScriptedStick::ScriptedStick(const StickSpec& spec, const Scenario& scenario, std::uint64_t seed)
    : spec_(spec),
      goal_(scenario.goal),
      arrives_within_m_(kArrived * scenario.goal_tolerance_m),
      meant_(kRemembered),
      random_(seed, Purpose::kStick) {
  if (spec.kind != StickKind::kTable) return;
  LineReader reader(spec.file, kStickRows);
  reader.read_table("t_s,forward,left", 3, [&](const std::vector<double>& v, const std::string& line) {
    const bool sound =
        !v.empty() && (table_.empty() || v[0] > table_.back().t_s) && std::fabs(v[1]) <= 1.0 && std::fabs(v[2]) <= 1.0;
    if (!sound) reader.refuse("\"" + shown(line) + "\" is no row of it");
    table_.push_back({v[0], {v[1], v[2]}});
  });
  if (table_.empty()) throw StartupError(spec.file.string() + ": holds no row", kStickRows);
}

Stick ScriptedStick::at(const Truth& truth) noexcept {
  const double now_s = to_seconds(truth.now);
  tremble(now_s - before_s_);
  before_s_ = now_s;
  meant_[next_++ % kRemembered] = {now_s, meant(truth)};
  Stick stick = delayed(now_s);
  if (stick.is_centred()) return stick;
  stick.forward = std::clamp(stick.forward + off_forward_, -1.0, 1.0);
  stick.left = std::clamp(stick.left + off_left_, -1.0, 1.0);
  return stick;
}

Stick ScriptedStick::meant(const Truth& truth) const noexcept {
  if (spec_.kind == StickKind::kStraight) return {spec_.forward, 0.0};
  if (spec_.kind == StickKind::kToGoal) return meant_to_goal(truth);
  const auto after = std::find_if(table_.begin(), table_.end(),
                                  [now_s = to_seconds(truth.now)](const Row& row) { return row.t_s > now_s; });
  return after == table_.begin() ? Stick{} : std::prev(after)->stick;
}

/// Points at the goal as if nothing were in between.
Stick ScriptedStick::meant_to_goal(const Truth& truth) const noexcept {
  const Vec2 to = goal_ - truth.map_from_robot.position();
  if (norm(to) < arrives_within_m_) return {};
  const double off = wrap_angle(atan2(to.y, to.x) - truth.map_from_robot.heading);
  const double ahead = std::fabs(off) < kTurnsFirst_rad ? spec_.forward : 0.0;
  return {ahead, std::clamp(kLeftPerRad * off, -1.0, 1.0)};
}

/// The newest that was meant spec_.delay_s ago or before; nothing before the first.
Stick ScriptedStick::delayed(double now_s) noexcept {
  for (std::size_t back = 1; back <= std::min(next_, kRemembered); ++back) {
    const Row& row = meant_[(next_ - back) % kRemembered];
    if (row.t_s <= now_s - spec_.delay_s) return row.stick;
  }
  return {};
}

/// Ornstein and Uhlenbeck's process, a share of the stick's way.
void ScriptedStick::tremble(double dt_s) noexcept {
  if (spec_.noise_std <= 0.0 || dt_s <= 0.0) return;
  const double keeps = std::max(0.0, 1.0 - dt_s / kTremble_s), adds = spec_.noise_std * std::sqrt(1.0 - keeps * keeps);
  off_forward_ = keeps * off_forward_ + adds * random_.normal();
  off_left_ = keeps * off_left_ + adds * random_.normal();
}

}  // namespace jaywalk::sim
