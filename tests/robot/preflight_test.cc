#include "firmware/robot/preflight.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "drivers/can/socketcan.h"
#include "firmware/robot/control_socket.h"
#include "firmware/robot/realtime.h"
#include "hal/types/errors.h"
#include "hil/emulators/byte_server.h"
#include "hil/emulators/scanners.h"
#include "tests/robot/local_socket.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;

namespace {

/// A robot whose bus is not there, and whose scanner's port belongs to nobody.
RobotFile nothing_connected() {
  RobotFile file = load_robot_file(tests::rig_file("robot"));
  file.drive.can = "nocan0";
  file.laser.port = emulators::TcpServer(0).port();  // free again
  file.laser.first_scan_limit = std::chrono::milliseconds(100);
  return file;
}

CheckedPart find(const std::vector<CheckedPart>& parts, const std::string& name) {
  const auto part = std::ranges::find(parts, name, &CheckedPart::part);
  REQUIRE(part != parts.end());
  return *part;
}

std::vector<CheckedPart> checked(const RobotFile& file) {
  SteadyClock clock;
  return preflight(file, tests::control_place(), clock);
}

/// Words on a SICK of 811 beams over 270 degrees whose first three measure `nearest_m`; `believe` changes the file.
std::string said_of_scanner(float nearest_m, const std::function<void(RobotFile&)>& believe = {}) {
  auto port = std::make_unique<emulators::TcpServer>(std::uint16_t{0});
  RobotFile file = nothing_connected();
  file.laser.port = port->port();
  file.laser.first_scan_limit = std::chrono::seconds(20);
  if (believe) believe(file);
  emulators::SickServer scanner(std::move(port), {}, [&](std::size_t first_beam, std::span<float> range_m) {
    for (std::size_t k = 0; k < range_m.size(); ++k) range_m[k] = first_beam + k < 3 ? nearest_m : 4.0F;
  });
  rig::RealLivingClock clock;
  clock.live = [&] { scanner.step(clock.now()); };
  std::string said;
  const std::string refusal = refusal_of([&] { said = check_scanner(file, clock); });
  return said + refusal;
}

}  // namespace

TEST_CASE("each of two scanners is told by its name, with what to do about one of its kind") {
  RobotFile file = nothing_connected();
  RobotModel& model = file.setup.model;
  REQUIRE(model.other_lasers.push_back(model.laser));
  model.laser.robot_from_laser.x = 0.2;
  model.other_lasers[0].robot_from_laser = {-0.2, 0.0, kPi};
  file.other_lasers.push_back(file.laser);
  file.laser.kind = ScannerKind::kDds;
  file.laser.topic = "/scan_of_nobody";
  const std::vector<CheckedPart> parts = checked(file);
  CHECK(holds(find(parts, "front scanner").said, "; start the robot's ROS 2 nodes"));
  CHECK(holds(find(parts, "rear scanner").said, ": no scan: scanner unreachable; see that"));
}

TEST_CASE("each part that is missing is told with what to do about it, and the others all the same") {
  RobotFile file = nothing_connected();
  file.panel = panel::JoystickSetup{.path = "/dev/input/by-id/none"};
  const std::vector<CheckedPart> parts = checked(file);
  REQUIRE(parts.size() == 8);  // no drives where there is no bus
  static_cast<void>(find(parts, "clock"));
  CHECK(find(parts, "control socket").is_well);
  CHECK_FALSE(find(parts, "nocan0").is_well);
  CHECK(find(parts, "nocan0").said ==
        "no such interface; load its driver, then: ip link set nocan0 up type can bitrate 500000");
  CHECK_FALSE(find(parts, "scanner").is_well);
  CHECK(holds(find(parts, "scanner").said, ": no scan: scanner unreachable; see that"));
  CHECK_FALSE(find(parts, "joystick").is_well);
  CHECK_FALSE(std::filesystem::exists(tests::control_place()));
}

TEST_CASE("what is no joystick, or has not the stop button, is refused by check and run") {
  RobotFile file = nothing_connected();
  const std::string pipe = std::filesystem::temp_directory_path() / ("jaywalk_stop_" + std::to_string(::getpid()));
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  file.panel = panel::JoystickSetup{.path = pipe};
  const std::vector<CheckedPart> parts = checked(file);
  CHECK_FALSE(find(parts, "joystick").is_well);
  CHECK(find(parts, "joystick").said.starts_with(pipe + ": is no input device"));
  CHECK_THROWS_AS(require_joystick(*file.panel), StartupError);
  std::filesystem::remove(pipe);
  CHECK_NOTHROW(require_joystick(*file.panel));  // it may be plugged in later: until then it is a stop
}

TEST_CASE("an interface that is no CAN bus is told from one") {
  const LinkFacts loopback = link_facts("lo");
  CHECK(loopback.exists);
  CHECK_FALSE(loopback.is_can);
  CHECK_FALSE(link_facts("nocan0").exists);
  RobotFile file = nothing_connected();
  file.drive.can = "lo";
  const std::vector<CheckedPart> parts = checked(file);
  CHECK(find(parts, "lo").said.starts_with("is no CAN interface"));
}

TEST_CASE("a scanner whose fan is not the file's, by a step or more, is told") {
  for (const double steps : {-1.0, 1.0, 0.4}) {
    const std::string said = said_of_scanner(4.0F, [&](RobotFile& file) {
      file.setup.model.laser.fov_rad += steps * file.setup.model.laser.fov_rad / 810.0;
    });
    CAPTURE(steps, said);
    CHECK(holds(said, "correct [laser] beams and fov_deg") == (std::fabs(steps) > 0.5));
  }
}

TEST_CASE("a scanner that sees the robot's own body is told, for the robot would never drive") {
  const std::string on_it = said_of_scanner(0.10F);
  CHECK(holds(on_it, "3 of the beams end within the robot's own outline; take away what is before it"));
  CHECK(holds(on_it, "[[laser.blanked]] from_deg = -135.3, to_deg = -134.0"));
  Blanking as_told;
  (void)as_told.push_back({-135.3 * kPi / 180.0, -134.0 * kPi / 180.0});
  CHECK_FALSE(
      holds(said_of_scanner(0.10F, [&](RobotFile& file) { file.setup.model.laser.blanked = as_told; }), "outline"));
  const std::string before_it = said_of_scanner(0.60F);
  CHECK(holds(before_it, "811 beams"));  // a scan was looked at
  CHECK_FALSE(holds(before_it, "outline"));
}

TEST_CASE("who would plan is tried: a GPU that was asked for and is not there is a failure, otherwise the CPU plans") {
  RobotFile file = nothing_connected();
  const auto planner = [&](Backend backend) {
    file.setup.backend = backend;
    file.setup.device = 255;  // no machine has so many
    return find(checked(file), "planner");
  };
  CHECK(planner(Backend::kCpu).is_well);
  CHECK(planner(Backend::kCpu).said == "plans on the CPU");
  CHECK(planner(Backend::kAuto).is_well);
  CHECK(planner(Backend::kAuto).said.starts_with("plans on the CPU (cuda: no"));
  CHECK_FALSE(planner(Backend::kCuda).is_well);
  CHECK(planner(Backend::kCuda).said.starts_with("--backend cuda: no"));
}

TEST_CASE("the devices of a robot that runs are left alone") {
  const ControlSocket run(tests::control_place(), [](std::string_view) { return std::string("state: driving\n"); });
  const std::vector<CheckedPart> parts = checked(nothing_connected());
  REQUIRE(parts.size() == 4);
  CHECK(parts.back().part == "control socket");
  CHECK_FALSE(parts.back().is_well);
  CHECK(holds(parts.back().said, "another run listens there"));
}

TEST_CASE("a run that ended in order leaves no mark, one that was killed while armed does, for the same robot alone") {
  const Scratch scratch;
  {
    ArmedMark run(scratch.path(""), "can0");
    CHECK_FALSE(run.was_left());
    run.set();
    CHECK(ArmedMark(scratch.path(""), "can0").was_left());  // what a run would see that is started after a kill now
    CHECK_FALSE(ArmedMark(scratch.path(""), "can1").was_left());
  }
  CHECK_FALSE(ArmedMark(scratch.path(""), "can0").was_left());
}

TEST_CASE("a run that never armed leaves the mark of the one before") {
  const Scratch scratch;
  auto* killed = new ArmedMark(scratch.path(""), "can0");  // its end never comes
  killed->set();
  { const ArmedMark did_not_arm(scratch.path(""), "can0"); }
  CHECK(ArmedMark(scratch.path(""), "can0").was_left());
  delete killed;
}

TEST_CASE("a mark that cannot be written keeps a run from starting") {
  CHECK_THROWS_AS(ArmedMark("/nowhere/at/all", "can0"), StartupError);
}

TEST_CASE("a link in the mark's place is not followed, and latches") {
  const Scratch scratch;
  std::ofstream(scratch.path("precious")) << "kept";
  std::filesystem::create_symlink(scratch.path("precious"), scratch.path("jaywalk-can0.armed"));
  ArmedMark run(scratch.path(""), "can0");
  CHECK(run.was_left());
  CHECK_THROWS_AS(run.set(), StartupError);
  CHECK(scratch.read("precious") == "kept");
}

TEST_CASE("where the package has made a folder for marks every user's run uses it, or does not start") {
  const Scratch scratch;
  const std::filesystem::path shared = scratch.path("shared");
  CHECK(folder_of_marks(shared) == own_runtime_folder());
  std::filesystem::create_directory(shared);
  std::filesystem::permissions(shared, std::filesystem::perms::owner_all | std::filesystem::perms::group_all);
  CHECK(folder_of_marks(shared) == shared);
  ArmedMark service(folder_of_marks(shared), "can0");
  service.set();
  CHECK(ArmedMark(folder_of_marks(shared), "can0").was_left());
  CHECK(std::filesystem::status(shared / "jaywalk-can0.armed").permissions() == std::filesystem::perms{0660});
  std::filesystem::permissions(shared, std::filesystem::perms::all);
  CHECK_THROWS_AS(folder_of_marks(shared), StartupError);  // anybody's
  std::filesystem::create_directory_symlink(shared, scratch.path("link"));
  CHECK_THROWS_AS(folder_of_marks(scratch.path("link")), StartupError);
}

TEST_CASE("the folder for marks is this user's alone: one that is a link, or where others may write, is passed over") {
  const Scratch scratch;
  const std::string before = std::getenv("XDG_RUNTIME_DIR") != nullptr ? std::getenv("XDG_RUNTIME_DIR") : "";
  const std::filesystem::path mine = scratch.path("mine"), link = scratch.path("link");
  ::setenv("XDG_RUNTIME_DIR", mine.c_str(), 1);
  CHECK(own_runtime_folder() == mine);
  CHECK(std::filesystem::status(mine).permissions() == std::filesystem::perms::owner_all);
  std::filesystem::permissions(mine, std::filesystem::perms::all);
  CHECK(own_runtime_folder() != mine);
  std::filesystem::permissions(mine, std::filesystem::perms::owner_all);
  std::filesystem::create_directory_symlink(mine, link);
  ::setenv("XDG_RUNTIME_DIR", link.c_str(), 1);
  CHECK(own_runtime_folder() != link);
  before.empty() ? ::unsetenv("XDG_RUNTIME_DIR") : ::setenv("XDG_RUNTIME_DIR", before.c_str(), 1);
}
