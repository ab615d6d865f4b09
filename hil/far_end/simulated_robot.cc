#include "hil/far_end/simulated_robot.h"

#include <limits>
#include <utility>

#include "firmware/robot/robot_devices.h"

namespace jaywalk::rig {
namespace {

constexpr Duration kEncoderPeriod = std::chrono::milliseconds(10);
constexpr std::size_t kMostOld = 50;  // readings: half a second

/// Shaped as the controller believes, and mounted so where the scenario has no truth about it; as noisy as that says.
LaserModel laser_of(const sim::Scenario& scenario, const RobotFile& wiring, std::size_t index) {
  LaserModel laser = wiring.setup.model.lasers()[index];
  if (index == 0) laser.robot_from_laser = scenario.truth.robot_from_laser.value_or(laser.robot_from_laser);
  laser.noise_m = scenario.model.laser.noise_m;
  return laser;
}

constexpr std::size_t kMostMessages = 100'000;

/// The file with the ports that the scanners' wires really have.
RobotFile with_ports(RobotFile file, const FarWires& wires) {
  for (std::size_t k = 0; k < wires.size(); ++k) {
    LaserWiring& laser = k == 0 ? file.laser : file.other_lasers[k - 1];
    if (const auto* const network = dynamic_cast<const emulators::TcpServer*>(wires[k].get()))
      laser.port = network->port();
  }
  return file;
}

/// At any port that is free where it is one; the file is told.
std::unique_ptr<emulators::ServedBytes> make_far_line(ByteWiring& line, Clock& clock) {
  line.port = 0;
  auto wire = make_far_wire(line);
  if (const auto* const network = dynamic_cast<const emulators::TcpServer*>(wire.get())) line.port = network->port();
  return std::make_unique<emulators::ServedBytes>(std::move(wire), clock);
}

std::vector<std::unique_ptr<ScannerConnection>> make_lasers(const RobotFile& file, Clock& clock) {
  std::vector<std::unique_ptr<ScannerConnection>> lasers;
  for (std::size_t k = 0; k < file.lasers().size(); ++k) lasers.push_back(make_laser(file, clock, k));
  return lasers;
}

}  // namespace

SimulatedRobot::SimulatedRobot(const sim::Scenario& scenario, std::uint64_t seed, const RobotFile& wiring,
                               const Buses& buses, FarWires wires, Time now)
    : began_(now),
      world_(scenario, seed),
      wheel_radius_m_(scenario.model.drive.wheel_radius_m),
      buses_(buses),
      wiring_(wiring.drive),
      drives_(make_wheel_drives(wiring.drive, buses)) {
  for (std::size_t k = 0; k < wires.size(); ++k) {
    const LaserModel laser = laser_of(scenario, wiring, k);
    eyes_.push_back(std::make_unique<Eye>(Eye{k, laser, sim::Random(seed, sim::Purpose::kRange, k)}));
    Eye& eye = *eyes_.back();
    eye.scanner =
        make_far_scanner(wiring.lasers()[k], laser, std::move(wires[k]),
                         [this, &eye](std::size_t first, std::span<float> range_m) { look(eye, first, range_m); });
  }
}

void SimulatedRobot::step(Time now) {
  if (twin_) twin_->step(now);
  for (const auto& drive : drives_) drive->step(now);
  while (world_.now() + (began_.time_since_epoch()) < now) {
    turn_wheels();
    world_.step();
  }
  for (const auto& eye : eyes_) eye->scanner->step(now);
}

void SimulatedRobot::turn_wheels() {
  world_.plant().command({world_.now(), drives_[0]->speed_radps(), drives_[1]->speed_radps()}, world_.now());
  if (age(encoders_read_, world_.now()) < kEncoderPeriod) return;
  encoders_read_ = world_.now();
  read_encoders();
  drives_[0]->measure_wheel(shown_.left_radps, shown_.left_rad);
  drives_[1]->measure_wheel(shown_.right_radps, shown_.right_rad);
}

void SimulatedRobot::read_encoders() {
  read_.push_back(world_.plant().read_encoders(world_.now()));
  if (read_.size() > kMostOld) read_.pop_front();
  const double old_s = senses_.feedback_ages * std::max(to_seconds(age(deceived_, world_.now())), 0.0);
  const auto old = static_cast<std::size_t>(std::min(old_s, 1.0) / to_seconds(kEncoderPeriod));
  const WheelState& wheels = read_[read_.size() - 1 - std::min(old, read_.size() - 1)];
  if (!senses_.counters_stand) shown_.left_rad = wheels.left_rad, shown_.right_rad = wheels.right_rad;
  if (!senses_.speeds_stand) shown_.left_radps = wheels.left_radps, shown_.right_radps = wheels.right_radps;
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
void SimulatedRobot::look(Eye& eye, std::size_t first_beam, std::span<float> range_m) {
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const double range = range_along(eye, first_beam + k) + eye.laser.noise_m * eye.noise.normal();
    range_m[k] = range < eye.laser.range_min_m   ? 0.0F
                 : range > eye.laser.range_max_m ? std::numeric_limits<float>::infinity()
                                                 : static_cast<float>(range);
  }
}

double SimulatedRobot::range_along(Eye& eye, std::size_t beam) {
  const FalseSenses senses = eye.index == senses_.scanner ? senses_ : FalseSenses{};
  const double looked = eye.scanner->shape().angle_rad(beam);
  double& range = eye.last_range_m[std::min(beam, kMaxBeams - 1)];
  if (looked > senses.repeats.from_rad && looked < senses.repeats.to_rad) return range;
  const Pose2 map_from_laser = truth().map_from_robot * eye.laser.robot_from_laser;
  const double angle = world_.fault_active(sim::FaultKind::kScannerMirrored, eye.index) ? -looked : looked;
  const Vec2 towards = direction(map_from_laser.heading + senses.mount_turned_rad + angle);
  range = world_.walls().cast(map_from_laser.position(), towards, eye.laser.range_max_m);
  for (const sim::Disc& body : world_.movers_seen())
    range = std::min(range, hit_range(map_from_laser.position(), towards, body));
  return range;
}

InProcessRobot::InProcessRobot(RobotFile file, const sim::Scenario& scenario, std::uint64_t seed, Clock& clock,
                               const Run& run)
    : InProcessRobot(file, scenario, seed, clock, run, make_far_wires(file, true)) {}

InProcessRobot::InProcessRobot(RobotFile file, const sim::Scenario& scenario, std::uint64_t seed, Clock& clock,
                               const Run& run, FarWires wires)
    : observer_(run.observer != nullptr ? *run.observer : nobody_),
      clock_(clock),
      file_(with_ports(std::move(file), wires)),
      wires_(clock, seed),
      far_line_(run.real_line ? make_far_line(file_.drive.line, clock) : nullptr),
      line_(run.real_line ? make_bus(file_.drive, clock) : nullptr),
      bus_(line_ ? *line_ : wires_.port(0), clock),
      far_end_(scenario, seed, file_, places(), std::move(wires), clock.now()),
      lasers_(make_lasers(file_, clock)),
      drive_(make_drive(file_.drive, bus_, clock)),
      controls_(file_, *drive_, clock, [] { return std::string(); }),
      runner_(file_.setup, hal(), {run.out}, observer_, run.make_planner),
      guard_([] {}, clock, std::chrono::seconds(1)),
      loop_(runner_, {*drive_, lasers_, bus_, controls_.resets()}, controls_.desk(), clock, guard_, observer_) {
  messages_.reserve(kMostMessages);
}

SimulatedRobot::Buses InProcessRobot::places() noexcept {
  if (far_line_) return {far_line_.get(), far_line_.get()};
  return {&wires_.port(1), &wires_.port(2)};
}

Hal InProcessRobot::hal() {
  Hal hal{*lasers_.front(), *drive_, controls_.panel(), controls_.desk().told_place(), clock_};
  for (std::size_t k = 1; k < lasers_.size(); ++k) (void)hal.other_lasers.push_back(lasers_[k].get());
  return hal;
}

void InProcessRobot::step_far_end() {
  far_end_.step(clock_.now());
  controls_.step();
  const Time now = clock_.now();
  while (messages_.size() < far_end_.scanner().messages_sent()) messages_.push_back(now);
}

}  // namespace jaywalk::rig
