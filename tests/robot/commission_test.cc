// Commissioning over wires, both ends in this process, time moved on by hand: every miswiring is refused.
#include "apps/setup/scan_surfels.h"
#include "apps/setup/watched_drive.h"
#include "firmware/robot/preflight.h"
#include "hal/types/errors.h"
#include "tests/robot/wired_bench.h"
#include "tests/support/file_size_limit.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

using Rewire = std::function<void(RobotFile&)>;

sim::Scenario world(std::optional<sim::FaultKind> miswired) {
  sim::Scenario scenario = tests::empty_hall();
  if (miswired) scenario.faults = {{.at_s = 0.0, .for_s = 1000.0, .kind = *miswired}};
  return scenario;
}

struct Bench : tests::LiveBench {
  /// `miswired`: the far end; `believe` changes what the controller believes.
  explicit Bench(const std::string& name, std::optional<sim::FaultKind> miswired = {}, const Rewire& believe = {})
      : LiveBench([&](const Scratch& folder) { return tests::robot_in(folder.folder(), tests::rig_file(name)); },
                  [&](const RobotFile&) { return world(miswired); }) {
    if (believe) believe(file);
    static_cast<void>(arm());
  }
  std::vector<CheckedPart> commission(const std::function<bool()>& stopped = [] { return false; }) {
    std::vector<LaserScanner*> lasers;
    for (const auto& laser : robot.lasers()) lasers.push_back(laser.get());
    const RobotModel& model = file.setup.model;
    return judge_nudges(nudge_wheels({model, robot.drive(), lasers, clock, stopped, file.setup.tick()}), model);
  }
};

std::string faults_of(const std::vector<CheckedPart>& checks) {
  std::string words;
  for (const CheckedPart& check : checks) {
    if (!check.is_well) words += check.part + ": " + check.said + "\n";
  }
  return words;
}

void check_says(const std::string& name, const std::string& words, std::optional<sim::FaultKind> miswired,
                const Rewire& believe = {}) {
  const std::string said = faults_of(Bench(name, miswired, believe).commission());
  CAPTURE(name, said);
  CHECK(holds(said, words));
}

void check_scans_tell(const char* robot) {
  check_says(robot, "the left wheel goes backward", sim::FaultKind::kLeftWheelReversed);
  check_says(robot, "left and right are exchanged", sim::FaultKind::kWheelsSwapped);
  check_says(robot, "scanner is upside down", sim::FaultKind::kScannerMirrored);
  check_says(robot, "the robot does not", sim::FaultKind::kNoGrip);
}

}  // namespace

TEST_CASE("a robot that is wired as its file says passes every check, on all kinds of drive") {
  for (const char* name : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    CAPTURE(name);
    Bench bench(name);
    const std::vector<CheckedPart> checks = bench.commission();
    CHECK(faults_of(checks) == "");
    CHECK(checks.size() == 7);
    CHECK(bench.speed_mps() < 0.001);
    CHECK(bench.far_end().truth().contacts == 0);
  }
}

TEST_CASE("motors that turn the other way, and one that does not turn, are named by their drives") {
  check_says("robot", "left drive: its encoder counts backwards", sim::FaultKind::kBothMotorsReversed);
  check_says("robot", "left drive: its encoder counts backwards", sim::FaultKind::kLeftMotorReversed);
  check_says("robot", "left drive: its wheel does not turn", sim::FaultKind::kLeftWheelStuck);
}

TEST_CASE("what only the scans tell is named: a wheel reversed, sides exchanged or a scanner upside down, no grip") {
  check_scans_tell("robot");
}

TEST_CASE("what only the scans tell is named with other drives and scanners, too", "[long]") {
  check_scans_tell("odrive_hokuyo");
  check_scans_tell("vesc_ld19");
}

TEST_CASE("a wheel that is a fifth larger, a mount turned by 30 degrees, ahead of or behind its place are refused") {
  const std::pair<const char*, Rewire> wrong[] = {
      {"left counts: the scans show 0.8", [](RobotFile& f) { f.setup.model.drive.wheel_radius_m *= 1.2; }},
      {"correct [laser] mount", [](RobotFile& f) { f.setup.model.laser.robot_from_laser.heading = kPi / 6.0; }},
      {"m farther ahead of the drive axle", [](RobotFile& f) { f.setup.model.laser.robot_from_laser.x -= 0.2; }},
      {"m farther behind the drive axle", [](RobotFile& f) { f.setup.model.laser.robot_from_laser.x += 0.25; }}};
  for (const auto& [words, believe] : wrong) check_says("robot", words, {}, believe);
}

TEST_CASE("each of two scanners is judged by what it sees, and told by its name") {
  Bench well("two_scanners");
  const std::vector<CheckedPart> checks = well.commission();
  CHECK(faults_of(checks) == "");
  CHECK(checks.size() == 11);  // the drives and their response once, four parts of each scanner
  Bench ahead("two_scanners", std::nullopt,
              [](RobotFile& file) { file.setup.model.other_lasers[0].robot_from_laser.heading = 0.0; });
  const std::string faults = faults_of(ahead.commission());
  CAPTURE(faults);
  CHECK(faults.starts_with("rear scanner: wheels, scanner: "));  // and nothing of the front one
}

TEST_CASE(
    "with something near, be it for the rear scanner alone, or when it is told to stop, no wheel goes on turning") {
  Bench rear("two_scanners", {}, [](RobotFile& file) { file.setup.model.footprint.rear_m = 3.0; });
  CHECK_THROWS_WITH(rear.commission(), Catch::Contains("something stands too near"));
  CHECK(rear.speed_mps() < 0.001);
  Bench near("robot", {}, [](RobotFile& file) { file.setup.model.footprint.half_width_m = 1.9; });
  CHECK_THROWS_AS(near.commission(), StartupError);
  CHECK(near.speed_mps() < 0.001);
  Bench bench("robot");
  CHECK_THROWS_AS(bench.commission([&] { return bench.speed_mps() > 0.05; }), StartupError);
  bench.clock.sleep_until(bench.clock.now() + 500ms);
  CHECK(bench.speed_mps() < 0.001);
}

TEST_CASE("what was found is kept beside the robot file, and counts for that wiring alone") {
  Bench bench("robot");
  const std::filesystem::path robot = bench.scratch.path("mine.toml");
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kNotYet);
  CHECK(holds(require_commissioned(robot, bench.file, true), "never commissioned"));
  CHECK_THROWS_WITH(require_commissioned(robot, bench.file, false), Catch::Contains("--uncommissioned"));
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}});
  CHECK(std::filesystem::exists(bench.scratch.path("mine.commissioned.json")));
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kPassed);
  CHECK(require_commissioned(robot, bench.file, false).empty());
  RobotFile changed = bench.file;
  changed.drive.cia402.axes[0].per_rad *= -1.0;
  CHECK(holds(require_commissioned(robot, changed, true), "changed since"));
  CHECK_THROWS_AS(require_commissioned(robot, changed, false), StartupError);
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}, {"right drive", false, "broken"}});
  CHECK_THROWS_AS(require_commissioned(robot, bench.file, true), StartupError);
  CHECK(holds(require_commissioned(robot, changed, true), "changed since"));
  std::ofstream(bench.scratch.path("mine.commissioned.json")) << "{\"wiring\": 7";
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kNotYet);
}

TEST_CASE("a commissioning that was begun leaves no pass of before, and its record is replaced whole") {
  Bench bench("robot");
  const std::filesystem::path robot = bench.scratch.path("mine.toml"), record = commissioned_path(robot);
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}});
  std::filesystem::create_hard_link(record, bench.scratch.path("first"));
  withdraw_commissioned(robot, bench.file);
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kFailed);
  CHECK_THROWS_AS(require_commissioned(robot, bench.file, true), StartupError);
  std::filesystem::rename(bench.scratch.path("first"), record);  // nobody wrote into it
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kPassed);
  for (const auto& entry : std::filesystem::directory_iterator(bench.scratch.folder()))
    CHECK_FALSE(holds(entry.path().string(), ".commissioned.json."));
}

TEST_CASE("a record that cannot be written is an error, and what stood there stays") {
  Bench bench("robot");
  const std::filesystem::path robot = bench.scratch.path("mine.toml");
  write_commissioned(robot, bench.file, {{"left drive", true, "well"}});
  const FileSizeLimit full(16);
  CHECK_THROWS_AS(write_commissioned(robot, bench.file, {{"left drive", true, "well again"}}), StartupError);
  CHECK(read_commissioned(robot, bench.file).state == Commissioned::kPassed);
}
