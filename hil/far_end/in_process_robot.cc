#include "hil/far_end/in_process_robot.h"

#include "firmware/robot/robot_devices.h"

namespace jaywalk::rig {
namespace {

constexpr std::size_t kMostMessages = 100'000;

/// The file with the port that the scanner's wire really has.
RobotFile with_port(RobotFile file, const emulators::ByteServer& wire) {
  if (const auto* const network = dynamic_cast<const emulators::TcpServer*>(&wire)) file.laser.port = network->port();
  return file;
}

std::unique_ptr<emulators::ByteServer> wire_for(LaserWiring wiring) {
  wiring.port = 0;  // any that is free
  return make_far_wire(wiring);
}

}  // namespace

InProcessRobot::InProcessRobot(RobotFile file, const sim::Scenario& scenario, std::uint64_t seed, Clock& clock,
                               const std::filesystem::path& out, const LoopRunner::Wrap& wrap, TickObserver& observer)
    : InProcessRobot(file, scenario, seed, clock, out, wrap, observer, wire_for(file.laser)) {}

InProcessRobot::InProcessRobot(RobotFile file, const sim::Scenario& scenario, std::uint64_t seed, Clock& clock,
                               const std::filesystem::path& out, const LoopRunner::Wrap& wrap, TickObserver& observer,
                               std::unique_ptr<emulators::ByteServer> wire)
    : clock_(clock),
      file_(with_port(std::move(file), *wire)),
      wires_(clock, seed),
      bus_(wires_.port(0), clock),
      far_end_(scenario, seed, file_, {&wires_.port(1), &wires_.port(2)}, std::move(wire), clock.now()),
      laser_(make_laser(file_, clock)),
      drive_(make_drive(file_.drive, bus_, clock)),
      controls_(file_, *drive_, clock, [] { return std::string(); }),
      runner_(file_.setup, {*laser_, *drive_, controls_.panel(), controls_.desk().told_place(), clock}, out, true,
              observer, wrap),
      guard_(no_brake_, clock, std::chrono::seconds(1)),
      loop_(runner_, {*drive_, *laser_, bus_, controls_.resets()}, controls_.desk(), clock, guard_, observer) {
  messages_.reserve(kMostMessages);
}

TickObserver& InProcessRobot::nobody() {
  static TickObserver does_nothing;
  return does_nothing;
}

void InProcessRobot::step_far_end() {
  far_end_.step(clock_.now());
  controls_.step();
  const Time now = clock_.now();
  while (messages_.size() < far_end_.scanner().messages_sent()) messages_.push_back(now);
}

}  // namespace jaywalk::rig
