// A Pioneer with its own board and an LMS200, by the file of deploy/config: whole drives over serial lines and TCP.
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

struct PioneerBench {
  PioneerBench(bool over_tcp, double rate_hz, bool allow_unproved = false)
      : folder(std::filesystem::temp_directory_path() / ("jaywalk_pioneer_" + std::to_string(::getpid()))),
        period(duration_from_seconds(1.0 / rate_hz)),
        robot(file(over_tcp, rate_hz, allow_unproved), world(), 3, clock, {folder, {}, nullptr, true}) {
    clock.live = [this] {
      robot.step_far_end();
      robot.laser().step();
    };
    while (robot.laser().latest().sequence == 0 && clock.now() < Time{5s}) clock.sleep_until(clock.now() + 1ms);
  }
  ~PioneerBench() { std::filesystem::remove_all(folder); }

  [[nodiscard]] RobotFile file(bool over_tcp, double rate_hz, bool allow_unproved) {
    std::filesystem::create_directories(folder);
    RobotFile wiring = load_robot_file(std::string(JAYWALK_EXAMPLES) + "/pioneer-p3dx-arcos.toml");
    wiring.setup.backend = Backend::kCpu;
    wiring.setup.rate_hz = rate_hz;
    wiring.setup.start = {2.0, 3.0, 1.2};
    wiring.laser.device = folder / "scanner";
    wiring.drive.line.device = folder / "board";
    if (over_tcp) wiring.drive.line.host = "127.0.0.1";
    wiring.drive.arcos.allow_unproved = allow_unproved;
    model = wiring.setup.model;
    return wiring;
  }
  [[nodiscard]] sim::Scenario world() const {
    sim::Scenario hall = sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml");
    hall.model = model;
    hall.model.laser.noise_m = 0.01;
    return hall;
  }
  void tick() {
    due += period;
    clock.sleep_until(due);
    robot.loop().tick(due);
    robot.runner().drain();
    while (robot.loop().traces().front() != nullptr) robot.loop().traces().pop();
  }
  [[nodiscard]] std::vector<std::string> arm() {
    const std::vector<std::string> report = robot.drive().arm();
    due = clock.now();
    return report;
  }
  [[nodiscard]] std::string refusal() {
    try {
      static_cast<void>(robot.drive().arm());
    } catch (const StartupError& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::string status() { return robot.desk().obey("status"); }

  std::filesystem::path folder;
  Duration period;
  rig::HandLivingClock clock;
  RobotModel model;
  rig::InProcessRobot robot;
  Time due{};
};

}  // namespace

TEST_CASE("a Pioneer with an LMS200 drives from start to goal over a pseudo terminal and over TCP, at 50 and 20 Hz") {
  for (const bool over_tcp : {false, true}) {
    const double rate_hz = over_tcp ? 20.0 : 50.0;
    CAPTURE(over_tcp, rate_hz);
    PioneerBench bench(over_tcp, rate_hz);
    const std::vector<std::string> report = bench.arm();
    REQUIRE(report.size() == 2);
    CHECK(report[0].find(": Pioneer p3dx-sh, SipCycle 100, TicksMM 128, TransAccel 900, ") != std::string::npos);
    CHECK(report[0].find("NOT PROVED") == std::string::npos);
    for (int k = 0; k < rate_hz; ++k) bench.tick();
    REQUIRE(bench.robot.desk().obey("goto 9 8") == "going\n");
    const Time limit = bench.due + 90s;
    while (bench.due < limit && bench.status().rfind("state: reached\n", 0) != 0) bench.tick();
    INFO(bench.status());
    CHECK(bench.status().rfind("state: reached\n", 0) == 0);
    const sim::Truth& truth = bench.robot.far_end().truth();
    CHECK(distance(truth.map_from_robot.position(), {9.0, 8.0}) < 0.4);
    CHECK(truth.contacts_caused == 0);
    CHECK(bench.robot.drive().trouble() == DriveTrouble::kNone);
  }
}

TEST_CASE("a Pioneer of which a line is torn stops, and a reset has it drive again once the line is back") {
  PioneerBench bench(true, 50.0);
  static_cast<void>(bench.arm());
  for (int k = 0; k < 50; ++k) bench.tick();
  REQUIRE(bench.robot.desk().obey("goto 9 8") == "going\n");
  for (int k = 0; k < 300; ++k) bench.tick();
  REQUIRE(bench.robot.far_end().rim_speed() > 0.2);
  bench.robot.far_line()->wire().drop_peer();
  for (int k = 0; k < 150; ++k) bench.tick();
  CHECK(bench.robot.drive().trouble() == DriveTrouble::kBusUnwell);
  CHECK(bench.robot.far_end().rim_speed() == 0.0);
  CHECK(bench.robot.desk().obey("reset").rfind("refused", 0) != 0);
  for (int k = 0; k < 200; ++k) bench.tick();
  INFO(bench.status());
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  for (int k = 0; k < 200; ++k) bench.tick();
  CHECK(bench.robot.far_end().rim_speed() > 0.05);
}

TEST_CASE("a Pioneer that nobody answers for is refused with its line and a remedy") {
  PioneerBench bench(false, 50.0);
  bench.robot.far_end().drive(0).pull_cable();
  CHECK(bench.refusal().find("board: no Pioneer answers; switch it on") != std::string::npos);
  bench.robot.far_line()->wire().set_present(false);
  CHECK(bench.refusal().find("board: cannot be opened; plug it in") != std::string::npos);
}
