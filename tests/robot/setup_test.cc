// `jaywalk setup` on emulated robots: drives on an in-process bus, the scanner behind a real port or pseudo terminal.
// And on a machine to which nothing is connected: what a person knows.
#include <array>
#include <fstream>
#include <sstream>

#include "hal/robot_model_file.h"
#include "tests/robot/emulated_machine.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

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

std::string scanner_at(const EmulatedMachine& machine) {
  return "[laser]\nhost = \"127.0.0.1\"\nport = " + std::to_string(machine.ports[0]) + "\n";
}

/// Whether the robot reaches a place 2 m on with this file, both ends in this process, time moved on by hand.
bool drives_with(const RobotFile& drafted) {
  tests::LiveBench bench(
      [&](const Scratch&) {
        RobotFile file = drafted;
        file.setup.backend = Backend::kCpu;
        return file;
      },
      [](const RobotFile&) { return tests::empty_hall(); });
  static_cast<void>(bench.arm());
  bench.tick(25);
  bench.go(0, "goto 3.5 4.5");
  return bench.tick_until(2000, [&] { return distance(bench.truth().position(), {3.5, 4.5}) < 0.3; });
}

/// What a person knows of the robot with two scanners; `mount` is the rear one's line.
std::string known_of_two(const EmulatedMachine& machine, const std::string& mount) {
  const auto laser = [&machine](std::size_t k) {
    return "[[laser]]\nhost = \"127.0.0.1\"\nport = " + std::to_string(machine.ports[k]) + "\nrange_m = 25\n";
  };
  return "model = \"p3dx\"\nmax_speed_mps = 0.6\nstart = [2.0, 3.0, 1.2]\n" + laser(0) + "mount = [0.2, 0.0, 0.0]\n" +
         laser(1) + mount + "[[laser.blanked]]\nfrom_deg = 130\nto_deg = 134\n" +
         "[drive]\ncounts_per_wheel_turn = 76600\n";
}

/// Nothing is connected, and there is no CAN.
Surroundings bare_machine() {
  const auto none = [] { return std::vector<std::string>(); };
  const auto no_bus = [](const std::string& interface) -> std::unique_ptr<CanBus> {
    throw StartupError(interface + ": no such interface", "none");
  };
  return {none, none, none, none, no_bus};
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
    CHECK(holds(machine.file_text, "# joystick /dev/input/by-id/usb-Pad-event-joystick"));
    CHECK(file.setup.model.laser.beams == of.beams);
    CHECK_THAT(file.setup.model.laser.fov_rad * 180.0 / kPi, Catch::Matchers::WithinAbs(of.fov_deg, 0.3));
    CHECK(file.setup.model.laser.rate_hz == of.rate_hz);
    for (const std::size_t side : {0U, 1U})
      CHECK_FALSE(make_drive(file.drive, machine.wires.port(0), machine.clock)->inspect(side).empty());
    CHECK(machine.robot->rim_speed() == 0.0);
    CHECK(drives_with(file));
  }
}

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
  CHECK(drives_with(file));
}

TEST_CASE("where the second scanner is mounted cannot be guessed") {
  EmulatedMachine machine("two_scanners");
  CHECK_THROWS_WITH(machine.drafted(known_of_two(machine, "")), Catch::Contains("setup: laser 2.mount cannot be seen"));
}

TEST_CASE("at a terminal a further scanner that answers is asked for") {
  EmulatedMachine machine("vesc_ld19", true);
  const TypedSetup setup = typed_setup(machine, machine.clock, "p3dx\n\n\n50\n\n\n2\n\nyes\n[-0.2, 0, 3.14]\nno\n");
  check_holds(setup.said, {"Has the robot a further scanner? [yes/no] laser 2.mount: "});
  const std::string text = setup.draft.text();
  CHECK(text.find("scanner_rear\"") < text.find("scanner\""));  // in the order in which they were chosen
  check_holds(text, {"[[laser]]\n", "mount = [0.0, 0.0, 0.0] ", "mount = [-0.2, 0, 3.14] "});
}

TEST_CASE("CiA 402 drives are found by their profile and named by their identity") {
  EmulatedMachine machine("robot");
  const FoundDrives drives = find_drives(machine.wires.port(0), machine.clock);
  REQUIRE(drives.kind == DriveKind::kCia402);
  REQUIRE(drives.nodes.size() == 2);
  CHECK(drives.nodes.contains(3));
  check_holds(drives.nodes.at(2), {"vendor ", "serial number "});
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
  CHECK_THROWS_WITH(machine.drafted("model = \"p3dx\"\n[laser]\nhost = \"127.0.0.1\"\n"),
                    Catch::Contains("setup: drive.motor_turns_per_wheel_turn cannot be seen: the gear; put it into "));
}

TEST_CASE("an answer that ROBOT.toml does not know, or that is out of its range, is refused with its line") {
  EmulatedMachine machine("odrive_hokuyo");
  const std::string well = with_port(kRobots[1], machine);
  const std::pair<std::string, const char*> refused[] = {
      {well + "colour = 3\n", "answers.toml:9: drive.colour is not a known key"},
      // Before anything that it would have told is missed.
      {"model = \"p3dx\"\n[drive]\nmotor_turns_per_weel_turn = 10\n",
       "answers.toml:3: drive.motor_turns_per_weel_turn is not a known key; did you mean motor_turns_per_wheel_turn?"},
      {"[laser]\nhots = \"here\"\n", "answers.toml:2: laser.hots is not a known key; did you mean host?"},
      {"[drives]\n", "answers.toml:1: drives is not a known key; did you mean drive?"},
      {well + "left_node = 500\n", "answers.toml:9: drive.left_node is 500; choose a value from"},
      {well + "kind = \"vesc\"\n", "drive.kind is answered as vesc, and vcan0 has odrive"},
      {well + "[[places]]\nat = [1, 2]\nplan = 3\n", "places.plan is not a known key"}};
  for (const auto& [text, complaint] : refused)
    check_holds(refusal_of([&] { return machine.drafted(text); }), {complaint});
}

TEST_CASE("at a terminal what cannot be seen is asked, what is nonsense again, and a return takes the suggestion") {
  EmulatedMachine machine("odrive_hokuyo");
  const TypedSetup setup = typed_setup(machine, machine.clock, "p3dx\n\n4\nmany\n10\n\n\n[0.1, 0, 0]\nyes\n\n",
                                       machine.answers(scanner_at(machine)));
  check_holds(setup.draft.text(), {"model = \"p3dx\"", "left_node = 3 ", "right_node = 4 ",
                                   "motor_turns_per_wheel_turn = 10 ", "right_reversed = true ", "mount = [0.1, 0, 0] ",
                                   "joystick = \"/dev/input/by-id/usb-Pad-event-joystick\""});
  check_holds(setup.said, {"drive.motor_turns_per_wheel_turn: the gear (0.1 to 1000): not one of these"});
}

TEST_CASE("where no model is named at a terminal, the robot is measured, and a model file is written for it") {
  EmulatedMachine machine("odrive_hokuyo");
  const TypedSetup setup =
      typed_setup(machine, machine.clock, "\n0.3\n0.28\n0.25\n0.1\n0.45\n12\n\n4\n10\n\n\n[0.1, 0, 0]\nyes\n\n",
                  machine.answers(scanner_at(machine)));
  CAPTURE(setup.draft.model(), setup.said);
  const RobotModel model = load_robot_model(machine.scratch.write("measured_model.toml", setup.draft.model()));
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

TEST_CASE("without CAN and scanner a file is written from what a person knows, who is told first what was found") {
  const Surroundings machine = bare_machine();
  rig::HandLivingClock clock;
  const TypedSetup setup =
      typed_setup(machine, clock, "p4dx\np3dx\n\n\n2\n3\n76600\n\n\nsick-cola-b\n127.0.0.1\n9\n\n");
  CHECK(setup.said.starts_with("Found: no drives: no CAN interface\nFound: no scanner\nmodel: "));
  CHECK(holds(setup.said, "p4dx"));  // what is wrong with it, at the prompt
  check_holds(setup.draft.text(),
              {"kind = \"cia402\"", "can = \"can0\"", "right_node = 3 ", "host = \"127.0.0.1\"", "port = 9 "});
}

TEST_CASE("what was answered before a setup was broken off is not asked again") {
  const Surroundings machine = bare_machine();
  rig::HandLivingClock clock;
  const Scratch scratch;
  const std::string kept = scratch.path("answers");
  CHECK_THROWS_WITH(typed_setup(machine, clock, "p3dx\n\n\n2\n", {}, kept), Catch::Contains("has what was answered"));
  const TypedSetup setup = typed_setup(machine, clock, "3\n76600\n\n\nsick-cola-b\n127.0.0.1\n9\n\n", {}, kept);
  CHECK(holds(setup.said, ": p3dx (as answered before)\n"));
  check_holds(setup.draft.text(), {"left_node = 2 ", "right_node = 3 ", "port = 9 "});
}

TEST_CASE("a model file that the answers name is found beside them, wherever the robot's file is written") {
  const Surroundings machine = bare_machine();
  rig::HandLivingClock clock;
  const Scratch scratch;
  std::filesystem::create_directories(scratch.path("other"));
  std::filesystem::copy_file(JAYWALK_EXAMPLES "/jackal.model.toml", scratch.path("mine.toml"));
  const std::string written = scratch.write(
      "answers.toml",
      "model = \"mine.toml\"\n[laser]\nkind = \"sick-cola-b\"\nhost = \"127.0.0.1\"\nport = 9\n[drive]\nkind = "
      "\"cia402\"\nleft_node = 2\nright_node = 3\ncounts_per_wheel_turn = 76600\n");
  SetupAnswers answers(written, nullptr, nullptr);
  const std::string robot = scratch.write("other/robot.toml", draft_robot(machine, answers, clock).text());
  CHECK(load_robot_file(robot).setup.model.name == "jackal");
}

TEST_CASE("setup finds a Pioneer's board and an LMS200 on serial lines, and the file arms") {
  EmulatedMachine machine("pioneer_lms200");
  const RobotFile file = machine.drafted(
      "model = \"p3dx\"\nstart = [2.0, 3.0, 1.2]\n[laser]\nkind = \"lms200\"\nrange_m = 8\n[drive]\nkind = "
      "\"pioneer\"\n");
  CAPTURE(machine.file_text);
  CHECK(file.drive.kind == DriveKind::kPioneer);
  CHECK(file.drive.line.device == machine.scratch.path("board"));
  CHECK(file.laser.device == machine.scratch.path("scanner"));
  CHECK(machine.robot->rim_speed() == 0.0);
  const auto bus = make_bus(file.drive, machine.clock);
  const auto drive = make_drive(file.drive, *bus, machine.clock);
  CHECK(holds(drive->arm()[0], ": Pioneer p3dx-sh"));
}
