#include "hil/far_end/in_process_robot.h"

#include "firmware/robot/robot_devices.h"

namespace jaywalk::rig {
namespace {

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
      guard_(no_brake_, clock, std::chrono::seconds(1)),
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
