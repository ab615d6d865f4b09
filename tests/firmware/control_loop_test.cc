#include "firmware/control_loop.h"

#include <bit>
#include <vector>

#include "tests/firmware/relived.h"
#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

std::vector<std::uint64_t> command_bits(SimulatedDrive drive, int ticks) {
  std::vector<std::uint64_t> bits;
  for (int k = 0; k < ticks; ++k) {
    const TickRecord& t = drive.tick();
    bits.push_back(std::bit_cast<std::uint64_t>(t.command.left_radps));
    bits.push_back(std::bit_cast<std::uint64_t>(t.command.right_radps));
  }
  return bits;
}

}  // namespace

TEST_CASE("a busy thousand ticks ask nothing of the heap") {
  SimulatedDrive drive("map1_16", 3);
  drive.drive(2.0);
  std::uint64_t plans = 0, tracks = 0;
  const std::uint64_t calls = drive.heap_calls(1000, [&](const TickRecord& t) {
    plans = t.plan_sequence;
    tracks = std::max<std::uint64_t>(tracks, drive.loop().tracker().moving().size());
  });
  CHECK(calls == 0);
  CHECK(plans > 90);  // 22 s at five a second: it was busy
  CHECK(tracks >= 2);
}

TEST_CASE("a wheelchair that searches its way out of a dead end asks nothing of the heap") {
  SimulatedDrive drive("dead_end", 3);
  drive.drive(2.0);
  int backwards = 0;
  CHECK(drive.heap_calls(1500, [&](const TickRecord& t) { backwards += t.verdict.permitted.v_mps < -0.02 ? 1 : 0; }) ==
        0);
  CHECK(backwards > 25);  // half a second: it did back out
}

TEST_CASE("a recorded drive replays to the same commands, bit for bit") {
  CHECK(different_commands(20.0) == 0);
  CHECK(different_commands(20.0, {}, PlanMode::kPaper) == 0);
}

TEST_CASE("blanked beams are the robot's own to whatever looks at a scan, and relived as such") {
  const auto blank_left = [](sim::Scenario& scenario) { (void)scenario.model.laser.blanked.push_back({1.0, 1.2}); };
  SimulatedDrive drive("map1_16", 7, blank_left);
  drive.drive(1.0);
  const LaserScan& scan = drive.tick().scan;
  for (std::size_t k = 0; k < scan.beam_count; ++k)
    CHECK(scan.too_near(k) == (scan.angle_rad(k) > 1.0 && scan.angle_rad(k) < 1.2));
  CHECK(different_commands(10.0, blank_left) == 0);
}

TEST_CASE("the same seed gives the same commands, another seed others") {
  const auto once = command_bits({"map1_04", 5}, 300);
  CHECK(once == command_bits({"map1_04", 5}, 300));
  CHECK(once != command_bits({"map1_04", 6}, 300));
}

TEST_CASE("without movers the goal is reached and nothing touched, with ranges that scatter by 5 cm as well") {
  for (const bool scatters : {false, true}) {
    CAPTURE(scatters);
    SimulatedDrive drive("crossing", 1, [&](sim::Scenario& scenario) {
      scenario.wanderers.clear();
      if (scatters) scenario.model.laser.noise_m = 0.05;
    });
    CHECK(drive.arrives(90.0));
  }
}

TEST_CASE("the potential is solved for what follows its path: mode paper alone") {
  const auto cycles = [](const SimulatedDrive::Edit& edit, PlanMode mode) {
    SimulatedDrive drive("map1_16", 3, edit, mode);
    drive.drive(2.0);
    CHECK(drive.loop().plan().status == PlanStatus::kOk);
    CHECK(drive.loop().plan().path.size() > 10);
    return drive.loop().plan().cycles;
  };
  CHECK(cycles({}, PlanMode::kFull) == 0);
  CHECK(cycles({}, PlanMode::kPaper) > 0);
  CHECK(cycles([](sim::Scenario& s) { s.model = wheelchair(); }, PlanMode::kFull) == 0);
}

TEST_CASE("mode paper keeps one speed from start to goal, its verdicts are recorded and not applied") {
  const auto press_the_button = [](sim::Scenario& scenario) {
    scenario.wanderers.clear();
    scenario.pose_source.enabled = true;
    scenario.faults = {{.at_s = 5.0, .for_s = 2.0, .kind = sim::FaultKind::kEmergencyStop}};
  };
  SimulatedDrive drive("crossing", 2, press_the_button, PlanMode::kPaper);
  drive.drive(3.0);  // speeding up
  double least_permitted = 1.0;
  for (int k = 0; k < 200; ++k) {
    const TickRecord& t = drive.tick();
    REQUIRE(t.wanted.v_mps == Approx(0.6));
    const double rim_mps = (t.command.left_radps + t.command.right_radps) / 2.0 * p3dx().drive.wheel_radius_m;
    REQUIRE(rim_mps == Approx(0.6));
    least_permitted = std::min(least_permitted, t.verdict.permitted.v_mps);
  }
  CHECK(least_permitted == 0.0);
}
