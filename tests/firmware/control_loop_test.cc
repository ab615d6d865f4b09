#include "firmware/control_loop.h"

#include <unistd.h>

#include <bit>
#include <filesystem>
#include <vector>

#include "tests/firmware/relived.h"
#include "tests/firmware/simulated_drive.h"
#include "tests/support/allocation_guard.h"
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

/// Records `seconds` of a drive, lives through the recording again and counts commands that differ in any bit.
int different_commands(PlanMode mode, double seconds, const SimulatedDrive::Edit& edit = {}) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("jaywalk_" + std::to_string(::getpid()) + ".jwr")).string();
  {
    SimulatedDrive drive("map1_16", 7, edit, mode, file);
    drive.drive(seconds);
    REQUIRE(drive.recorder().close());
  }
  const Relived relived = relive(file);
  REQUIRE(relived.ticks == static_cast<int>(seconds * 50.0));
  return relived.different;
}

}  // namespace

TEST_CASE("a busy thousand ticks ask nothing of the heap") {
  SimulatedDrive drive("map1_16", 3);
  drive.drive(2.0);
  std::uint64_t calls = 0, plans = 0, tracks = 0;
  for (int k = 0; k < 1000; ++k) {
    drive.sleep();
    const AllocationGuard guard;
    const TickRecord& t = drive.tick_now();
    calls += guard.calls();
    plans = t.plan_sequence;
    tracks = std::max<std::uint64_t>(tracks, drive.loop().tracker().moving().size());
  }
  CHECK(calls == 0);
  CHECK(plans > 90);  // 22 s at five a second: it was busy
  CHECK(tracks >= 2);
}

TEST_CASE("a wheelchair that searches its way out of a dead end asks nothing of the heap") {
  SimulatedDrive drive("dead_end", 3);
  drive.drive(2.0);
  std::uint64_t calls = 0, backwards = 0;
  for (int k = 0; k < 1500; ++k) {
    drive.sleep();
    const AllocationGuard guard;
    const TickRecord& t = drive.tick_now();
    calls += guard.calls();
    backwards += t.verdict.permitted.v_mps < -0.02 ? 1 : 0;
  }
  CHECK(calls == 0);
  CHECK(backwards > 25);  // half a second: it did back out
}

TEST_CASE("a recorded drive replays to the same commands, bit for bit") {
  CHECK(different_commands(PlanMode::kFull, 20.0) == 0);
  CHECK(different_commands(PlanMode::kPaper, 20.0) == 0);
}

TEST_CASE("blanked beams are the robot's own to whatever looks at a scan, and relived as such") {
  const auto blank_left = [](sim::Scenario& scenario) { (void)scenario.model.laser.blanked.push_back({1.0, 1.2}); };
  SimulatedDrive drive("map1_16", 7, blank_left);
  drive.drive(1.0);
  const LaserScan& scan = drive.tick().scan;
  for (std::size_t k = 0; k < scan.beam_count; ++k)
    CHECK(scan.too_near(k) == (scan.angle_rad(k) > 1.0 && scan.angle_rad(k) < 1.2));
  CHECK(different_commands(PlanMode::kFull, 10.0, blank_left) == 0);
}

TEST_CASE("the same seed gives the same commands, another seed others") {
  const auto once = command_bits({"map1_04", 5}, 300);
  CHECK(once == command_bits({"map1_04", 5}, 300));
  CHECK(once != command_bits({"map1_04", 6}, 300));
}

TEST_CASE("without movers the goal is reached and nothing touched") {
  SimulatedDrive drive("crossing", 1, [](sim::Scenario& scenario) { scenario.wanderers.clear(); });
  CHECK(drive.drive(90.0, [&](const TickRecord&) { return drive.to_goal_m() < 0.3; }));
  CHECK(drive.truth().contacts == 0);
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

TEST_CASE("with ranges that scatter by 5 cm the goal is reached as well") {
  SimulatedDrive drive("crossing", 1, [](sim::Scenario& scenario) {
    scenario.wanderers.clear();
    scenario.model.laser.noise_m = 0.05;
  });
  CHECK(drive.drive(90.0, [&](const TickRecord&) { return drive.to_goal_m() < 0.3; }));
  CHECK(drive.truth().contacts == 0);
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
