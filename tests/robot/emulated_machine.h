#pragma once
// Machine with an emulated robot at its wires, for `jaywalk setup`.
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "apps/setup/robot_setup.h"
#include "firmware/robot/robot_devices.h"
#include "tests/drivers/watched_port.h"
#include "tests/robot/wired_bench.h"

namespace jaywalk {

/// A machine at whose wires an emulated robot hangs that is wired like a file of tools/rig/drive.
class EmulatedMachine final : public Surroundings {
 public:
  /// `twice`: with another scanner like its own at its rear.
  explicit EmulatedMachine(const std::string& name, bool twice = false) : truth_(wiring(name, twice)), wires(clock, 3) {
    if (truth_.drive.kind == DriveKind::kPioneer)
      board_ = std::make_unique<emulators::ServedBytes>(rig::make_far_wire(truth_.drive.line), clock);
    rig::FarWires far_wires = rig::make_far_wires(truth_, true);
    for (const auto& wire : far_wires)
      if (const auto* const network = dynamic_cast<const emulators::TcpServer*>(wire.get()))
        ports.push_back(network->port());
    const rig::SimulatedRobot::Buses places = board_ ? rig::SimulatedRobot::Buses{board_.get(), board_.get()}
                                                     : rig::SimulatedRobot::Buses{&wires.port(1), &wires.port(2)};
    robot = std::make_unique<rig::SimulatedRobot>(tests::empty_hall(), 3, truth_, places, std::move(far_wires),
                                                  clock.now());
    clock.live = [this] { robot->step(clock.now()); };
    can_interfaces = [] { return std::vector<std::string>{"can0", "vcan0"}; };
    open_bus = [this](const std::string& interface) {
      if (interface != "vcan0") throw StartupError(interface + ": is down", "bring it up");
      return std::make_unique<tests::WatchedPort>(wires.port(0), clock);
    };
    serial_lines = [this] {
      std::vector<std::string> lines;
      for (const LaserWiring& laser : truth_.lasers())
        if (laser.host.empty()) lines.push_back(laser.device);
      if (board_) lines.push_back(truth_.drive.line.device);
      return lines;
    };
    hosts = [] { return std::vector<std::string>{"127.0.0.1"}; };
    joysticks = [] { return std::vector<std::string>{"/dev/input/by-id/usb-Pad-event-joystick"}; };
  }

  /// A file with these lines, for `setup --answers`.
  std::filesystem::path answers(const std::string& text) const { return scratch.write("answers.toml", text); }
  RobotFile drafted(const std::string& text) {
    SetupAnswers known(answers(text), nullptr, nullptr);
    file_text = draft_robot(*this, known, clock).text();
    return load_robot_file(scratch.write("robot.toml", file_text));
  }

  Scratch scratch;
  std::string file_text;
  rig::HandLivingClock clock;

 private:
  [[nodiscard]] RobotFile wiring(const std::string& name, bool twice) const {
    RobotFile file = tests::robot_in(scratch.folder(), tests::rig_file(name));
    file.drive.line.device = scratch.path("board");
    if (!twice) return file;
    file.other_lasers.push_back(file.laser);
    file.other_lasers[0].device += "_rear";
    REQUIRE(file.setup.model.other_lasers.push_back(file.setup.model.laser));
    file.setup.model.other_lasers[0].robot_from_laser = {-0.2, 0.0, kPi};
    return file;
  }

  RobotFile truth_;
  std::unique_ptr<emulators::ServedBytes> board_;  ///< of a Pioneer, at a pseudo terminal

 public:
  InProcessBus wires;
  std::vector<std::uint16_t> ports;
  std::unique_ptr<rig::SimulatedRobot> robot;
};

/// What a person types at a terminal makes a draft.
struct TypedSetup {
  RobotDraft draft;
  std::string said;  ///< to the person
};
inline TypedSetup typed_setup(const Surroundings& machine, Clock& clock, const std::string& typed,
                              const std::optional<std::filesystem::path>& answers = {},
                              const std::filesystem::path& kept = {}) {
  std::istringstream person(typed);
  std::ostringstream said;
  SetupAnswers known(answers, &person, &said, kept);
  RobotDraft draft = draft_robot(machine, known, clock);
  return {std::move(draft), said.str()};
}

inline void check_holds(const std::string& text, std::initializer_list<const char*> parts) {
  CAPTURE(text);
  for (const char* part : parts) CHECK(holds(text, part));
}

}  // namespace jaywalk
