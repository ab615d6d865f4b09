// Random trials of SAFETY 18 and 23 in rooms; by hand, as they take minutes: safety_tests "[trials]" prints a row a
// kind (JAYWALK_TRIALS of each, 200), safety_tests "[hours]" drives for JAYWALK_HOURS (1), from JAYWALK_FIRST_SEED
// (100000) on, without a fault.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

#include "tests/safety/trial_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using trials::Fault;

namespace {

struct Kind {
  Fault fault;
  const char* name;
};
const std::vector<Kind> kKinds{
    {Fault::kNearlyFrozen, "nearly frozen"},     {Fault::kJitterFrozen, "frozen but for noise"},
    {Fault::kSectorFrozen, "sector frozen"},     {Fault::kMountTurned, "mount turned at once"},
    {Fault::kMountTurning, "mount turns"},       {Fault::kWheelsFar, "wheels 1.3 to 2"},
    {Fault::kWheelsShort, "wheels 0.5 to 0.75"}, {Fault::kRangesFar, "ranges 1.25 to 2"},
    {Fault::kRangesShort, "ranges 0.5 to 0.8"},  {Fault::kCountersStuck, "counters stuck"},
    {Fault::kCounterStuck, "a counter stuck"}};

/// Of a trial: motion that showed the fault until it was told.
struct Shown {
  bool counts = false;  ///< it was struck at speed, unaccused
  bool told = false;
  double motion_s = 0.0, way_m = 0.0;
};

Shown tried(Fault fault, std::uint64_t seed) {
  trials::Engine engine(seed * 7919 + 17);
  const double strikes_s = seed % 4 == 0 ? 0.0 : trials::uniform(engine, 3.0, 8.0);
  trials::TrialRobot robot(seed, fault, strikes_s);
  Shown shown;
  while (robot.now_s() < strikes_s + 12.0) {
    robot.tick();
    if (robot.accused()) {
      shown.counts = shown.told = robot.struck();
      return shown;
    }
    if (!robot.shows()) continue;
    shown.motion_s += 0.02;
    shown.counts = shown.motion_s > 0.5;  // else it hardly moved
    shown.way_m += 0.02 * robot.speed_mps();
  }
  return shown;
}

struct Row {
  int trials = 0, in_time = 0, never = 0;
  std::vector<double> motion_s, way_m;
};

Row row_of(Fault fault, int trials, std::uint64_t first_seed) {
  Row row;
  for (std::uint64_t seed = first_seed; row.trials < trials; ++seed) {
    const Shown shown = tried(fault, seed);
    if (!shown.counts) continue;
    if (std::getenv("JAYWALK_SEEDS") != nullptr && !(shown.told && shown.motion_s <= 0.5))
      std::printf("seed %d: told %d, %.2f s, %.2f m\n", static_cast<int>(seed), shown.told, shown.motion_s,
                  shown.way_m);
    ++row.trials;
    row.in_time += shown.told && shown.motion_s <= 0.5 + 1e-9 ? 1 : 0;
    row.never += shown.told ? 0 : 1;
    row.motion_s.push_back(shown.motion_s);
    row.way_m.push_back(shown.way_m);
  }
  std::sort(row.motion_s.begin(), row.motion_s.end());
  std::sort(row.way_m.begin(), row.way_m.end());
  return row;
}

void print(const Kind& kind, const Row& row) {
  const auto at = [](const std::vector<double>& values, double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  std::printf(
      "%-22s %4d %5.1f %% in 0.5 s, never %3d; motion p50 %.2f p95 %.2f most %.2f s; way p95 %.2f most %.2f m\n",
      kind.name, row.trials, 100.0 * row.in_time / row.trials, row.never, at(row.motion_s, 0.5), at(row.motion_s, 0.95),
      row.motion_s.back(), at(row.way_m, 0.95), row.way_m.back());
  std::fflush(stdout);
}

}  // namespace

TEST_CASE("trials: a table of all kinds", "[.][trials]") {
  const int count = std::getenv("JAYWALK_TRIALS") != nullptr ? std::atoi(std::getenv("JAYWALK_TRIALS")) : 200;
  for (const Kind& kind : kKinds) print(kind, row_of(kind.fault, count, 1));
}

TEST_CASE("people who walk along are no blind sector, a turn on the spot close to a long wall is no contradiction") {
  // Without the bound kOthers of motion_model.cc each of the first four robots is stopped. By the other two, where a
  // surface was one beam's range, the match went 2 cm along the wall to where the noise of both scans agreed.
  const std::uint64_t seed = GENERATE(101231U, 101299U, 102018U, 102118U, 400221U, 400860U);
  trials::TrialRobot robot(seed, Fault::kNone, 0.0);
  while (robot.now_s() < (seed < 400000U ? 21.0 : 15.0) && !robot.accused()) robot.tick();
  CAPTURE(seed, robot.now_s());
  CHECK_FALSE(robot.accused());
}

TEST_CASE("trials: hours without a fault", "[.][hours]") {
  const double hours = std::getenv("JAYWALK_HOURS") != nullptr ? std::atof(std::getenv("JAYWALK_HOURS")) : 1.0;
  const char* const first = std::getenv("JAYWALK_FIRST_SEED");
  double driven_s = 0.0, way_m = 0.0;
  int false_faults = 0;
  for (std::uint64_t seed = first != nullptr ? std::strtoul(first, nullptr, 10) : 100000; driven_s < 3600.0 * hours;
       ++seed) {
    trials::TrialRobot robot(seed, Fault::kNone, 0.0);
    double stood_s = 0.0;  // wedged in: the next room
    for (bool accused = false; robot.now_s() < 60.0 && !accused && stood_s < 6.0;) {
      robot.tick();
      stood_s = robot.speed_mps() > 0.05 ? 0.0 : stood_s + 0.02;
      driven_s += stood_s > 1.0 ? 0.0 : 0.02;
      way_m += 0.02 * robot.speed_mps();
      accused = robot.accused();
      if (accused)
        std::printf("seed %d: %.2f s, %s\n", static_cast<int>(seed), robot.now_s(), to_string(robot.reasons()).c_str());
      false_faults += accused ? 1 : 0;
    }
  }
  std::printf("%.1f hours, %.1f km, %d false faults\n", driven_s / 3600.0, way_m / 1000.0, false_faults);
  CHECK(false_faults == 0);
}
