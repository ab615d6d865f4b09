// Commissioning over wires, both ends in this process, time moved on by hand: every miswiring is refused.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "apps/setup/scan_surfels.h"
#include "apps/setup/watched_drive.h"
#include "firmware/robot/commissioned.h"
#include "hal/types/errors.h"
#include "hil/far_end/simulated_robot.h"
#include "tests/support/catch.h"
#include "tests/support/file_size_limit.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

using Rewire = std::function<void(RobotFile&)>;

struct Bench {
  /// `rewire` changes what the far end is wired like; the controller believes its file.
  Bench(const std::string& name, std::optional<sim::FaultKind> miswired, const Rewire& believe = {})
      : folder(std::filesystem::temp_directory_path() /
               ("jaywalk_commission_" + std::to_string(::getpid()) + "_" + std::to_string(benches++))),
        file(wiring(name)),
        robot(file, scenario(miswired), 3, clock, {folder}) {
    if (believe) believe(file);
    clock.live = [this] {
      robot.step_far_end();
      for (const auto& laser : robot.lasers()) laser->step();
    };
    for (const auto& laser : robot.lasers()) {
      while (laser->latest().sequence == 0 && clock.now() < Time{5s}) clock.sleep_until(clock.now() + 1ms);
    }
    static_cast<void>(robot.drive().arm());
  }
  ~Bench() { std::filesystem::remove_all(folder); }
  [[nodiscard]] RobotFile wiring(const std::string& name) const {
    std::filesystem::create_directories(folder);
    RobotFile wired = load_robot_file(std::string(JAYWALK_RIG) + "/drive/" + name + ".toml");
    wired.setup.backend = Backend::kCpu;
    if (wired.laser.host.empty()) wired.laser.device = folder / "scanner";
    return wired;
  }
  static sim::Scenario scenario(std::optional<sim::FaultKind> miswired) {
    sim::Scenario scenario = sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml");
    scenario.wanderers.clear();
    if (miswired) scenario.faults = {{.at_s = 0.0, .for_s = 1000.0, .kind = *miswired}};
    return scenario;
  }
  std::vector<CheckedPart> commission(const std::function<bool()>& stopped = [] { return false; }) {
    const NudgeSetup setup{.model = file.setup.model, .tick = file.setup.tick()};
    std::vector<LaserScanner*> lasers;
    for (const auto& laser : robot.lasers()) lasers.push_back(laser.get());
    return judge_nudges(nudge_wheels(setup, robot.drive(), lasers, clock, stopped), file.setup.model);
  }

  static inline int benches = 0;
  std::filesystem::path folder;
  rig::HandLivingClock clock;
  RobotFile file;
  rig::InProcessRobot robot;
};

std::string faults_of(const std::vector<CheckedPart>& checks) {
  std::string words;
  for (const CheckedPart& check : checks) {
    if (!check.is_well) words += check.part + ": " + check.said + "\n";
  }
  return words;
}

std::string faults_with(sim::FaultKind miswired, const std::string& name = "robot") {
  return faults_of(Bench(name, miswired).commission());
}

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

void check_says(sim::FaultKind miswired, const std::string& name, const std::string& words) {
  const std::string said = faults_with(miswired, name);
  CAPTURE(name, said);
  CHECK(says(said, words));
}

}  // namespace

TEST_CASE("a robot that is wired as its file says passes every check, on all kinds of drive") {
  for (const char* name : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    CAPTURE(name);
    Bench bench(name, std::nullopt);
    const std::vector<CheckedPart> checks = bench.commission();
    CHECK(faults_of(checks) == "");
    CHECK(checks.size() == 7);
    CHECK(bench.robot.far_end().rim_speed() < 0.001);
    CHECK(bench.robot.far_end().truth().contacts == 0);
  }
}

TEST_CASE("motors that turn the other way, and one that does not turn, are named by their drives") {
  check_says(sim::FaultKind::kBothMotorsReversed, "robot", "left drive: its encoder counts backwards");
  check_says(sim::FaultKind::kLeftMotorReversed, "robot", "left drive: its encoder counts backwards");
  check_says(sim::FaultKind::kLeftWheelStuck, "robot", "left drive: its wheel does not turn");
}

namespace {

void check_scans_tell(const char* robot) {
  check_says(sim::FaultKind::kLeftWheelReversed, robot, "the left wheel goes backward");
  check_says(sim::FaultKind::kWheelsSwapped, robot, "left and right are exchanged");
  check_says(sim::FaultKind::kScannerMirrored, robot, "scanner is upside down");
  check_says(sim::FaultKind::kNoGrip, robot, "the robot does not");
}

}  // namespace

TEST_CASE("what only the scans tell is named: a wheel reversed, sides exchanged or a scanner upside down, no grip") {
  check_scans_tell("robot");
}

TEST_CASE("what only the scans tell is named with other drives and scanners, too", "[long]") {
  check_scans_tell("odrive_hokuyo");
  check_scans_tell("vesc_ld19");
}

TEST_CASE("a model whose wheel is a fifth larger, and a mount that is turned by 30 degrees, are refused") {
  Bench larger("robot", std::nullopt, [](RobotFile& file) { file.setup.model.drive.wheel_radius_m *= 1.2; });
  CHECK(says(faults_of(larger.commission()), "left counts: the scans show 0.8"));
  Bench turned("robot", std::nullopt,
               [](RobotFile& file) { file.setup.model.laser.robot_from_laser.heading = kPi / 6.0; });
  CHECK(says(faults_of(turned.commission()), "correct [laser] mount"));
}

TEST_CASE("a mount whose x does not begin at the axle is refused, ahead and behind") {
  for (const double off_m : {0.2, -0.25}) {
    Bench off("robot", std::nullopt, [off_m](RobotFile& file) { file.setup.model.laser.robot_from_laser.x -= off_m; });
    const std::string said = faults_of(off.commission());
    CAPTURE(off_m, said);
    CHECK(says(said, off_m > 0.0 ? "m farther ahead of the drive axle" : "m farther behind the drive axle"));
  }
}

TEST_CASE("each of two scanners is judged by what it sees, and told by its name") {
  Bench well("two_scanners", std::nullopt);
  const std::vector<CheckedPart> checks = well.commission();
  CHECK(faults_of(checks) == "");
  CHECK(checks.size() == 11);  // the drives and their response once, four parts of each scanner
  Bench ahead("two_scanners", std::nullopt,
              [](RobotFile& file) { file.setup.model.other_lasers[0].robot_from_laser.heading = 0.0; });
  const std::string faults = faults_of(ahead.commission());
  CAPTURE(faults);
  CHECK(faults.starts_with("rear scanner: wheels, scanner: "));  // and nothing of the front one
}

TEST_CASE("what the rear scanner alone sees near keeps the wheels at rest") {
  Bench bench("two_scanners", std::nullopt, [](RobotFile& file) { file.setup.model.footprint.rear_m = 3.0; });
  CHECK_THROWS_WITH(bench.commission(), Catch::Contains("something stands too near"));
  CHECK(bench.robot.far_end().rim_speed() < 0.001);
}

TEST_CASE("with something near, or when it is told to stop, no wheel goes on turning") {
  Bench near("robot", std::nullopt, [](RobotFile& file) { file.setup.model.footprint.half_width_m = 1.9; });
  CHECK_THROWS_AS(near.commission(), StartupError);
  CHECK(near.robot.far_end().rim_speed() < 0.001);
  Bench bench("robot", std::nullopt);
  CHECK_THROWS_AS(bench.commission([&] { return bench.robot.far_end().rim_speed() > 0.05; }), StartupError);
  bench.clock.sleep_until(bench.clock.now() + 500ms);
  CHECK(bench.robot.far_end().rim_speed() < 0.001);
}

TEST_CASE("what was found is kept beside the robot file, and counts for that wiring alone") {
  Bench bench("robot", std::nullopt);
  const std::filesystem::path robot = bench.folder / "mine.toml";
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kNotYet);
  CHECK(says(require_commissioned(robot, bench.file, true), "never commissioned"));
  CHECK_THROWS_WITH(require_commissioned(robot, bench.file, false), Catch::Contains("--uncommissioned"));
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}});
  CHECK(std::filesystem::exists(bench.folder / "mine.commissioned.json"));
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kPassed);
  CHECK(require_commissioned(robot, bench.file, false).empty());
  RobotFile changed = bench.file;
  changed.drive.cia402.axes[0].per_rad *= -1.0;
  CHECK(says(require_commissioned(robot, changed, true), "changed since"));
  CHECK_THROWS_AS(require_commissioned(robot, changed, false), StartupError);
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}, {"right drive", false, "broken"}});
  CHECK_THROWS_AS(require_commissioned(robot, bench.file, true), StartupError);
  CHECK(says(require_commissioned(robot, changed, true), "changed since"));
  std::ofstream(bench.folder / "mine.commissioned.json") << "{\"wiring\": 7";
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kNotYet);
}

TEST_CASE("a commissioning that was begun leaves no pass of before, and its record is replaced whole") {
  Bench bench("robot", std::nullopt);
  const std::filesystem::path robot = bench.folder / "mine.toml", record = commissioned_path(robot);
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}});
  std::filesystem::create_hard_link(record, bench.folder / "first");
  withdraw_commissioned(robot, bench.file);
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kFailed);
  CHECK_THROWS_AS(require_commissioned(robot, bench.file, true), StartupError);
  std::filesystem::rename(bench.folder / "first", record);  // nobody wrote into it
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kPassed);
  for (const auto& entry : std::filesystem::directory_iterator(bench.folder))
    CHECK(entry.path().string().find(".commissioned.json.") == std::string::npos);
}

TEST_CASE("a record that cannot be written is an error, and what stood there stays") {
  Bench bench("robot", std::nullopt);
  const std::filesystem::path robot = bench.folder / "mine.toml";
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}});
  const FileSizeLimit full(16);
  CHECK_THROWS_AS(write_commissioned(robot, bench.file, {{"left drive", true, "well again"}}), StartupError);
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kPassed);
}
