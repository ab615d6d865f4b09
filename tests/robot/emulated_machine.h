#pragma once
// Machine with an emulated robot at its wires, for `jaywalk setup`.
#include <unistd.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "apps/setup/robot_setup.h"
#include "firmware/robot/robot_devices.h"
#include "hal/types/errors.h"
#include "hil/far_end/simulated_robot.h"
#include "tests/support/catch.h"

namespace jaywalk {

inline bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// A machine at whose wires an emulated robot hangs that is wired like a file of tools/rig/drive.
class EmulatedMachine final : public Surroundings {
 public:
  /// `twice`: with another scanner like its own at its rear.
  explicit EmulatedMachine(const std::string& name, bool twice = false)
      : folder(std::filesystem::temp_directory_path() / ("jaywalk_setup_" + std::to_string(::getpid()))),
        truth_(wiring(name, twice)),
        wires(clock, 3) {
    if (truth_.drive.kind == DriveKind::kPioneer)
      board_ = std::make_unique<emulators::ServedBytes>(rig::make_far_wire(truth_.drive.line), clock);
    rig::FarWires far_wires = rig::make_far_wires(truth_, true);
    for (const auto& wire : far_wires)
      if (const auto* const network = dynamic_cast<const emulators::TcpServer*>(wire.get()))
        ports.push_back(network->port());
    const rig::SimulatedRobot::Buses places = board_ ? rig::SimulatedRobot::Buses{board_.get(), board_.get()}
                                                     : rig::SimulatedRobot::Buses{&wires.port(1), &wires.port(2)};
    robot = std::make_unique<rig::SimulatedRobot>(hall(), 3, truth_, places, std::move(far_wires), clock.now());
    clock.live = [this] { robot->step(clock.now()); };
  }
  ~EmulatedMachine() override { std::filesystem::remove_all(folder); }

  std::vector<std::string> can_interfaces() override { return {"can0", "vcan0"}; }
  std::unique_ptr<CanBus> open_bus(const std::string& interface) override {
    if (interface != "vcan0") throw StartupError(interface + ": is down", "bring it up");
    return std::make_unique<Lent>(wires.port(0));
  }
  std::vector<std::string> serial_lines() override {
    std::vector<std::string> lines;
    for (const LaserWiring& laser : truth_.lasers())
      if (laser.host.empty()) lines.push_back(laser.device);
    if (board_) lines.push_back(truth_.drive.line.device);
    return lines;
  }
  std::vector<std::string> hosts() override { return {"127.0.0.1"}; }
  std::vector<std::string> joysticks() override { return {"/dev/input/by-id/usb-Pad-event-joystick"}; }

  /// A file with these lines, for `setup --answers`.
  std::filesystem::path answers(const std::string& text) const {
    std::ofstream(folder / "answers.toml") << text;
    return folder / "answers.toml";
  }
  RobotFile drafted(const std::string& text) {
    SetupAnswers known(answers(text), nullptr, nullptr);
    file_text = draft_robot(*this, known, clock).text();
    std::ofstream(folder / "robot.toml") << file_text;
    return load_robot_file(folder / "robot.toml");
  }
  static sim::Scenario hall() {
    sim::Scenario scenario = sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml");
    scenario.wanderers.clear();
    return scenario;
  }

  std::filesystem::path folder;
  std::string file_text;
  rig::HandLivingClock clock;

 private:
  /// A place on the bus that is given back.
  class Lent final : public CanBus {
   public:
    explicit Lent(CanBus& bus) : bus_(bus) {}
    SendResult send(const CanFrame& frame) noexcept override { return bus_.send(frame); }
    bool receive(ReceivedFrame& received) noexcept override { return bus_.receive(received); }
    CanHealth health() const noexcept override { return bus_.health(); }

   private:
    CanBus& bus_;
  };

  [[nodiscard]] RobotFile wiring(const std::string& name, bool twice) const {
    std::filesystem::create_directories(folder);
    RobotFile file = load_robot_file(std::string(JAYWALK_RIG) + "/drive/" + name + ".toml");
    if (file.laser.host.empty()) file.laser.device = folder / "scanner";
    file.drive.line.device = folder / "board";
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

}  // namespace jaywalk
