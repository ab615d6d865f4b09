// `jaywalk setup` on emulated robots: drives on an in-process bus, the scanner behind a real port or pseudo terminal.
#include <unistd.h>

#include <array>
#include <fstream>
#include <sstream>

#include "apps/setup/robot_setup.h"
#include "firmware/robot/robot_devices.h"
#include "hal/robot_model_file.h"
#include "hal/types/errors.h"
#include "hil/far_end/simulated_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// A machine at whose wires an emulated robot hangs that is wired like a file of tools/rig/drive.
class EmulatedMachine final : public Surroundings {
 public:
  /// `twice`: with another scanner like its own at its rear.
  explicit EmulatedMachine(const std::string& name, bool twice = false)
      : folder(std::filesystem::temp_directory_path() / ("jaywalk_setup_" + std::to_string(::getpid()))),
        truth_(wiring(name, twice)),
        wires(clock, 3) {
    rig::FarWires far_wires = rig::make_far_wires(truth_, true);
    for (const auto& wire : far_wires)
      if (const auto* const network = dynamic_cast<const emulators::TcpServer*>(wire.get()))
        ports.push_back(network->port());
    robot = std::make_unique<rig::SimulatedRobot>(hall(), 3, truth_,
                                                  rig::SimulatedRobot::Buses{&wires.port(1), &wires.port(2)},
                                                  std::move(far_wires), clock.now());
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
    if (!twice) return file;
    file.other_lasers.push_back(file.laser);
    file.other_lasers[0].device += "_rear";
    REQUIRE(file.setup.model.other_lasers.push_back(file.setup.model.laser));
    file.setup.model.other_lasers[0].robot_from_laser = {-0.2, 0.0, kPi};
    return file;
  }

  RobotFile truth_;

 public:
  InProcessBus wires;
  std::vector<std::uint16_t> ports;
  std::unique_ptr<rig::SimulatedRobot> robot;
};

struct KnownOf {
  const char* robot;
  DriveKind kind;
  const char* known;  ///< what no device tells
  std::uint32_t beams;
  double fov_deg, rate_hz;
};
const std::array kRobots{
    KnownOf{"robot", DriveKind::kCia402,
            "model = \"p3dx\"\nmax_speed_mps = 0.6\nstart = [2.0, 3.0, 1.2]\n[laser]\nrange_m = 25\n[drive]\n"
            "counts_per_wheel_turn = 76600\n",
            811, 270.0, 15.0},
    KnownOf{"odrive_hokuyo", DriveKind::kOdrive,
            "model = \"p3dx\"\nstart = [2.0, 3.0, 1.2]\n[laser]\nhost = \"127.0.0.1\"\nrange_m = "
            "30\n[drive]\nmotor_turns_per_wheel_turn = 10\n",
            1521, 190.0, 20.0},
    KnownOf{"vesc_ld19", DriveKind::kVesc,
            "model = \"p3dx\"\nstart = [2.0, 3.0, 1.2]\n[laser]\nrange_m = 12\n[drive]\n"
            "electrical_turns_per_wheel_turn = 50\n",
            450, 359.2, 10.0}};

/// The answers with the port that the emulated scanner really has.
std::string with_port(const KnownOf& of, const EmulatedMachine& machine) {
  std::string text = of.known;
  if (!machine.ports.empty())
    text.insert(text.find("[laser]\n") + 8, "port = " + std::to_string(machine.ports[0]) + "\n");
  return text;
}

/// Whether the robot reaches a place 2 m on with this file, both ends in this process, time moved on by hand.
bool drives_with(RobotFile file, const std::filesystem::path& folder) {
  file.setup.backend = Backend::kCpu;
  rig::HandLivingClock clock;
  rig::InProcessRobot robot(file, EmulatedMachine::hall(), 3, clock, {folder / "run"});
  clock.live = [&] {
    robot.step_far_end();
    for (const auto& laser : robot.lasers()) laser->step();
  };
  for (const auto& laser : robot.lasers()) {
    while (laser->latest().sequence == 0 && clock.now() < Time{5s}) clock.sleep_until(clock.now() + 1ms);
  }
  static_cast<void>(robot.drive().arm());
  bool going = false;
  for (Time due = clock.now(), end = due + 40s; due < end;) {
    clock.sleep_until(due += 20ms);
    robot.loop().tick(due);
    robot.runner().drain();
    while (robot.loop().traces().front() != nullptr) robot.loop().traces().pop();
    going = going || says(robot.desk().obey("goto 3.5 4.5"), "going");  // refused before the first ticks
    if (norm(robot.far_end().truth().map_from_robot.position() - Vec2{3.5, 4.5}) < 0.3) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("setup drafts a file for each kind of drive which checks and drives") {
  for (const KnownOf& of : kRobots) {
    CAPTURE(of.robot);
    EmulatedMachine machine(of.robot);
    const RobotFile file = machine.drafted(with_port(of, machine));
    CAPTURE(machine.file_text);
    CHECK(file.drive.kind == of.kind);
    CHECK(file.drive.can == "vcan0");
    CHECK_FALSE(file.panel);  // a stick that nobody wished for
    CHECK(says(machine.file_text, "# joystick /dev/input/by-id/usb-Pad-event-joystick"));
    CHECK(file.setup.model.laser.beams == of.beams);
    CHECK_THAT(file.setup.model.laser.fov_rad * 180.0 / kPi, Catch::Matchers::WithinAbs(of.fov_deg, 0.3));
    CHECK(file.setup.model.laser.rate_hz == of.rate_hz);
    for (const std::size_t side : {0U, 1U})
      CHECK_FALSE(make_drive(file.drive, machine.wires.port(0), machine.clock)->inspect(side).empty());
    CHECK(machine.robot->rim_speed() == 0.0);
    CHECK(drives_with(file, machine.folder));
  }
}

namespace {

/// What a person knows of the robot with two scanners; `mount` is the rear one's line.
std::string known_of_two(const EmulatedMachine& machine, const std::string& mount) {
  const auto laser = [&machine](std::size_t k) {
    return "[[laser]]\nhost = \"127.0.0.1\"\nport = " + std::to_string(machine.ports[k]) + "\nrange_m = 25\n";
  };
  return "model = \"p3dx\"\nmax_speed_mps = 0.6\nstart = [2.0, 3.0, 1.2]\n" + laser(0) + "mount = [0.2, 0.0, 0.0]\n" +
         laser(1) + mount + "[[laser.blanked]]\nfrom_deg = 130\nto_deg = 134\n" +
         "[drive]\ncounts_per_wheel_turn = 76600\n";
}

}  // namespace

TEST_CASE("setup drafts each of two scanners with what it found of it, and the robot drives with both") {
  EmulatedMachine machine("two_scanners");
  const RobotFile file = machine.drafted(known_of_two(machine, "mount = [-0.2, 0.0, 3.14159]\n"));
  CAPTURE(machine.file_text);
  REQUIRE(file.lasers().size() == 2);
  CHECK(file.lasers()[1].port == machine.ports[1]);
  CHECK(file.setup.model.laser.beams == 541);
  const LaserModel& rear = file.setup.model.lasers()[1];
  CHECK(rear.beams == 811);
  CHECK(rear.rate_hz == 20.0);
  CHECK(rear.robot_from_laser == Pose2{-0.2, 0.0, 3.14159});
  CHECK(file.setup.model.laser.blanked.empty());
  CHECK(rear.blanked.size() == 1);
  CHECK(drives_with(file, machine.folder));
}

TEST_CASE("where the second scanner is mounted cannot be guessed") {
  EmulatedMachine machine("two_scanners");
  CHECK_THROWS_WITH(machine.drafted(known_of_two(machine, "")), Catch::Contains("setup: laser 2.mount cannot be seen"));
}

TEST_CASE("at a terminal a further scanner that answers is asked for") {
  EmulatedMachine machine("vesc_ld19", true);
  std::istringstream person("p3dx\n\n\n50\n\n\n2\n\nyes\n[-0.2, 0, 3.14]\nno\n");
  std::ostringstream said;
  SetupAnswers known(std::nullopt, &person, &said);
  const std::string text = draft_robot(machine, known, machine.clock).text();
  CAPTURE(text, said.str());
  CHECK(says(said.str(), "Has the robot a further scanner? [yes/no] laser 2.mount: "));
  CHECK(text.find("scanner_rear\"") < text.find("scanner\""));  // in the order in which they were chosen
  CHECK(says(text, "[[laser]]\n"));
  CHECK(says(text, "mount = [0.0, 0.0, 0.0] "));
  CHECK(says(text, "mount = [-0.2, 0, 3.14] "));
}

TEST_CASE("CiA 402 drives are found by their profile and named by their identity") {
  EmulatedMachine machine("robot");
  const FoundDrives drives = find_drives(machine.wires.port(0), machine.clock);
  REQUIRE(drives.kind == DriveKind::kCia402);
  REQUIRE(drives.nodes.size() == 2);
  CHECK(int{drives.nodes[0].node} == 2);
  CHECK(int{drives.nodes[1].node} == 3);
  CHECK(says(drives.nodes[0].said, "vendor "));
  CHECK(says(drives.nodes[0].said, "serial number "));
}

TEST_CASE("nothing is said on a bus where an ODrive speaks") {
  EmulatedMachine machine("odrive_hokuyo");
  const FoundDrives drives = find_drives(machine.wires.port(0), machine.clock);
  CHECK(drives.kind == DriveKind::kOdrive);
  ReceivedFrame received;
  std::size_t ours = 0;
  while (machine.wires.port(3).receive(received))
    ours += (received.frame.id & 0x1FU) == 0x01 || (received.frame.id & 0x1FU) == 0x09 ? 0 : 1;
  CHECK(ours == 0);
}

TEST_CASE("what cannot be seen and is not answered is named, with what it means") {
  EmulatedMachine machine("odrive_hokuyo");
  SetupAnswers known(machine.answers("model = \"p3dx\"\n[laser]\nhost = \"127.0.0.1\"\n"), nullptr, nullptr);
  try {
    static_cast<void>(draft_robot(machine, known, machine.clock));
    FAIL("it was drafted");
  } catch (const StartupError& error) {
    CAPTURE(error.what());
    CHECK(says(error.what(), "setup: drive.motor_turns_per_wheel_turn cannot be seen: the gear; put it into "));
  }
}

TEST_CASE("an answer that ROBOT.toml does not know, or that is out of its range, is refused with its line") {
  EmulatedMachine machine("odrive_hokuyo");
  const std::string well = with_port(kRobots[1], machine);
  const auto refused_as = [&](const std::string& text) {
    try {
      SetupAnswers known(machine.answers(text), nullptr, nullptr);
      static_cast<void>(draft_robot(machine, known, machine.clock));
    } catch (const StartupError& error) {
      return std::string(error.what());
    }
    return std::string("it was drafted");
  };
  CHECK(says(refused_as(well + "colour = 3\n"), "answers.toml:9: drive.colour is not a known key"));
  // Before anything that it would have told is missed.
  CHECK(says(
      refused_as("model = \"p3dx\"\n[drive]\nmotor_turns_per_weel_turn = 10\n"),
      "answers.toml:3: drive.motor_turns_per_weel_turn is not a known key; did you mean motor_turns_per_wheel_turn?"));
  CHECK(says(refused_as("[laser]\nhots = \"here\"\n"),
             "answers.toml:2: laser.hots is not a known key; did you mean host?"));
  CHECK(says(refused_as("[drives]\n"), "answers.toml:1: drives is not a known key; did you mean drive?"));
  CHECK(says(refused_as(well + "left_node = 500\n"), "answers.toml:9: drive.left_node is 500; choose a value from"));
  CHECK(says(refused_as(well + "kind = \"vesc\"\n"), "drive.kind is answered as vesc, and vcan0 has odrive"));
  CHECK(says(refused_as(well + "[[places]]\nat = [1, 2]\nplan = 3\n"), "places.plan is not a known key"));
}

TEST_CASE("at a terminal what cannot be seen is asked, what is nonsense again, and a return takes the suggestion") {
  EmulatedMachine machine("odrive_hokuyo");
  std::istringstream person("p3dx\n\n4\nmany\n10\n\n\n[0.1, 0, 0]\nyes\n\n");
  std::ostringstream said;
  const std::string port = "[laser]\nhost = \"127.0.0.1\"\nport = " + std::to_string(machine.ports[0]) + "\n";
  SetupAnswers known(machine.answers(port), &person, &said);
  const std::string text = draft_robot(machine, known, machine.clock).text();
  CAPTURE(text, said.str());
  CHECK(says(text, "model = \"p3dx\""));
  CHECK(says(text, "left_node = 3 "));
  CHECK(says(text, "right_node = 4 "));
  CHECK(says(text, "motor_turns_per_wheel_turn = 10 "));
  CHECK(says(text, "right_reversed = true "));
  CHECK(says(text, "mount = [0.1, 0, 0] "));
  CHECK(says(text, "joystick = \"/dev/input/by-id/usb-Pad-event-joystick\""));
  CHECK(says(said.str(), "drive.motor_turns_per_wheel_turn: the gear (0.1 to 1000): not one of these"));
}

TEST_CASE("where no model is named at a terminal, the robot is measured, and a model file is written for it") {
  EmulatedMachine machine("odrive_hokuyo");
  std::istringstream person("\n0.3\n0.28\n0.25\n0.1\n0.45\n12\n\n4\n10\n\n\n[0.1, 0, 0]\nyes\n\n");
  std::ostringstream said;
  const std::string port = "[laser]\nhost = \"127.0.0.1\"\nport = " + std::to_string(machine.ports[0]) + "\n";
  SetupAnswers known(machine.answers(port), &person, &said);
  const RobotDraft draft = draft_robot(machine, known, machine.clock);
  CAPTURE(draft.model(), said.str());
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "measured_model.toml";
  std::ofstream(file) << draft.model();
  const RobotModel model = load_robot_model(file);
  std::filesystem::remove(file);
  CHECK(model.footprint.rear_m == 0.28);
  CHECK(model.drive.track_width_m == 0.45);
  CHECK(model.drive.max_wheel_speed_radps == 12.0);
  CHECK(model.limits.brake_mps2 == p3dx().limits.brake_mps2);
  CHECK(model.laser.beams == p3dx().laser.beams);
}

TEST_CASE("what the answers say besides is taken over whole") {
  EmulatedMachine machine("odrive_hokuyo");
  const RobotFile file = machine.drafted(
      "rate_hz = 100\n" + with_port(kRobots[1], machine) +
      "allow_unproved = true\nleft_node = 4\nright_node = 3\n[[laser.blanked]]\nfrom_deg = 95\nto_deg = 110\n"
      "[realtime]\nrequired = false\n[[places]]\nname = \"hall\"\nat = [4.0, 1.5, 1.57]\n");
  CHECK(file.setup.rate_hz == 100.0);
  CHECK(file.drive.odrive.allow_unproved);
  CHECK(int{file.drive.odrive.axes[0].node} == 4);
  CHECK(file.setup.model.laser.blanked.size() == 1);
  CHECK_FALSE(file.realtime.required);
  REQUIRE(file.places.size() == 1);
  CHECK(file.places[0].name == "hall");
}
