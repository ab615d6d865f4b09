// Where no way is found for ten seconds, what may have gone while nothing looked there is in nobody's way any more.
#include <filesystem>
#include <fstream>

#include "firmware/control_loop.h"
#include "firmware/recording/recorder.h"
#include "hal/sim/simulation.h"
#include "tests/firmware/failing_planner.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using jaywalk::test::FailingPlanner;

namespace {

constexpr Vec2 kBeside{1.6, 4.6};  // left of the way, and soon behind a laser that looks ahead

/// A robot that drives past somebody who stands and then goes, unseen, and finds no path from six seconds on.
struct Bench {
  Bench() {
    setup.model = scenario.model;
    setup.start = scenario.start;
    setup.goal = scenario.goal;
    planner = std::make_unique<FailingPlanner>(setup.planner());
    loop = std::make_unique<ControlLoop>(setup, simulation.hal(), *planner, recorder);
  }
  static sim::Scenario with_somebody() {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "jaywalk_no_way_test.csv";
    std::ofstream(file) << "t_s,id,x_m,y_m\n0,1," << kBeside.x << ',' << kBeside.y << "\n6,1," << kBeside.x << ','
                        << kBeside.y << '\n';
    sim::Scenario scenario = sim::load_scenario(std::string(JAYWALK_SCENARIOS) + "/crossing.toml");
    scenario.wanderers.clear();
    scenario.recorded.push_back({.file = file});
    scenario.model.laser.fov_rad = kPi;
    return scenario;
  }
  void run_until(double t_s) {
    while (to_seconds(due) < t_s) {
      recorder.drain();
      simulation.hal().clock.sleep_until(due += setup.tick());
      last = loop->tick(due);
    }
  }
  [[nodiscard]] bool remembers_him() const {
    const EvidenceMap& still = loop->tracker().still();
    bool some = false;
    for (const double x : {-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3}) {
      for (const double y : {-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3})
        some = some || still.occupied(still.cell_at(kBeside + Vec2{x, y}));
    }
    return some;
  }

  sim::Scenario scenario = with_somebody();
  sim::Simulation simulation{scenario, 1};
  ControlSetup setup;
  Recorder recorder{{}};
  std::unique_ptr<FailingPlanner> planner;
  std::unique_ptr<ControlLoop> loop;
  TickRecord last;
  Time due{};
};

}  // namespace

TEST_CASE("who stood where nothing looks any more is forgotten after ten seconds at rest without a path") {
  Bench bench;
  bench.run_until(6.0);
  bench.planner->fails = GENERATE(false, true);
  bench.run_until(14.0);
  CHECK(bench.remembers_him());
  bench.run_until(20.0);
  CHECK((bench.last.verdict.permitted == Twist2{}) == bench.planner->fails);
  CHECK(bench.remembers_him() != bench.planner->fails);
}
